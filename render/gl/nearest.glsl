// Depth of the nearest of a pixel's samples.
uniform sampler2D depth_map;  // of the samples of a band; beyond it there is nothing
uniform ivec3 band;           // its first sample, from that of pixel 0, 0; samples a side to a pixel
float nearest_at(ivec2 pixel) {
  ivec2 first = pixel * band.z - band.xy, beyond = textureSize(depth_map, 0) - band.z;
  float nearest = 1.0;
  if (all(greaterThanEqual(first, ivec2(0))) && all(lessThanEqual(first, beyond)))
    for (int y = 0; y < band.z; ++y)
      for (int x = 0; x < band.z; ++x) nearest = min(nearest, texelFetch(depth_map, first + ivec2(x, y), 0).r);
  return nearest;
}
