// Depth of the nearest of a pixel's samples.
uniform sampler2D depth_map;  // of the samples of a band
uniform ivec3 band;           // its first sample, from that of pixel 0, 0; samples a side to a pixel
float nearest_at(ivec2 pixel) {
  ivec2 first = pixel * band.z - band.xy;
  float nearest = 1.0;
  for (int i = 0; i < band.z * band.z; ++i) nearest = min(nearest, texelFetch(depth_map, first + ivec2(i % band.z, i / band.z), 0).r);
  return nearest;
}
