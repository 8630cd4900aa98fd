// Which share of a pixel's samples lies before something: a pane has few.
uniform sampler2D depth_map;  // of the samples of a band; beyond it there is nothing
uniform ivec3 band;           // its first sample, from that of pixel 0, 0; samples a side to a pixel
float hidden_share(ivec2 pixel, float depth) {
  ivec2 first = pixel * band.z - band.xy, beyond = textureSize(depth_map, 0) - band.z;
  int before = 0;
  if (all(greaterThanEqual(first, ivec2(0))) && all(lessThanEqual(first, beyond)))
    for (int y = 0; y < band.z; ++y)
      for (int x = 0; x < band.z; ++x) before += int(texelFetch(depth_map, first + ivec2(x, y), 0).r < depth);
  return float(before) / float(band.z * band.z);
}
