// Sun, sky, haze, tone curve: what every surface is lit by.
#pragma once

#include "render/shade/kernels.h"
#include "render/shade/lanes.h"

namespace render::shade {
namespace {

constexpr float kSunLight[] = {1.95f, 1.83f, 1.63f};

LANES V3 haze_colour(const FrameData& f) {
  const float w = f.sun[3];
  return three(0.78f + (0.80f - 0.78f) * w, 0.84f + (0.82f - 0.84f) * w, 0.90f + (0.84f - 0.90f) * w);
}

/// Blue overhead, white towards the horizon, a glow around the sun.
LANES V3 sky_light(const FrameData& f, const V3& d) {
  const float w = f.sun[3], grey = 0.75f * w;
  const V3 blue = three(0.24f + (0.55f - 0.24f) * grey, 0.41f + (0.60f - 0.41f) * grey, 0.68f + (0.66f - 0.68f) * grey);
  const F band = exp(max(d.z, 0.0f) * -(5.5f + (3.0f - 5.5f) * w));
  const V3 c = mix(blue, haze_colour(f), band);
  const F s = max(dot(d, three(f.sun)), 0.0f), s2 = s * s, s4 = s2 * s2, s8 = s4 * s4;
  const F glow = 0.30f * s8 * s8 * s8 + 0.12f * s4 * s;
  return {c.x + glow, c.y + 0.86f * glow, c.z + 0.65f * glow};
}

/// What a mirror sees: sky above, a dim far edge of the land, asphalt below.
LANES V3 surroundings(const FrameData& f, const V3& d) {
  const V3 below = mix(three(0.21f, 0.205f, 0.20f), haze_colour(f) * 0.55f, exp(-6.0f * max(-d.z, 0.0f)));
  const V3 c = mix(below, sky_light(f, d), smoothstep(-0.02f, 0.03f, d.z));
  const F land = smoothstep(-0.05f, 0.0f, d.z) * (1.0f - smoothstep(0.05f, 0.16f, d.z));
  return mix(c, three(0.17f, 0.19f, 0.19f), 0.55f * land);
}

/// Light of the half sphere around a normal that rises by `up`, without the sun.
LANES V3 ambient_light(const FrameData& f, F up, F near_ground) {
  const float w = f.sun[3];
  const V3 above = three(0.36f + (0.47f - 0.36f) * w, 0.43f + (0.49f - 0.43f) * w, 0.53f + (0.50f - 0.53f) * w);
  const V3 below = {0.19f * near_ground, 0.18f * near_ground, 0.165f * near_ground};
  return mix(below, above, 0.5f + 0.5f * up);
}

LANES F haze_at(const FrameData& f, F distance_m) {
  const float w = f.sun[3];
  return 1.0f - exp(distance_m * -(0.0015f + (0.018f - 0.0015f) * w * w));
}

// Filmic curve (Narkowicz 2015, fit of the ACES reference) of 0.72 c, then sRGB: both in one, as a rational function of sqrt(c)
// that stays within 0.45 / 255 of them up to c = 10, where they reach white.
LANES F to_screen(F c) {
  const F s = sqrt(clamp(c, 0, 10));
  const F p = 0.00145106685f + s * (-0.187896814f + s * (6.04647127f + s * (-34.9294162f + s * 67.172244f)));
  const F q = 1.0f + s * (-7.33100167f + s * (22.7312445f + s * (-39.779932f + s * 67.3452571f)));
  return p / q;
}
LANES V3 to_screen(const V3& c) {
  return {to_screen(c.x), to_screen(c.y), to_screen(c.z)};
}

/// Noise of a pixel, 0..1 (Jimenez 2014, interleaved gradient noise).
LANES F pixel_noise(F x, F y) {
  return fract(52.9829189f * fract(x * 0.06711056f + y * 0.00583715f));
}

/// Half a step of noise hides the steps of eight bits in the sky.
LANES F dither(F x, F y) {
  return (pixel_noise(x, y) - 0.5f) * (1 / 255.0f);
}

/// The first `count` of eight pixels. Out of the tone curve, with or without noise, no value rounds below 0 or above 255.
LANES void put(const V3& c, int count, std::uint8_t* out) {
  const auto byte = [](F v) { return to_int(v * 255.0f + 0.5f); };
  const I rgba = byte(c.x) | byte(c.y) << 8 | byte(c.z) << 16 | static_cast<std::int32_t>(0xff000000u);
  if (count == kLanes)
    __builtin_memcpy(out, &rgba, sizeof rgba);
  else
    __builtin_memcpy(out, &rgba, sizeof(std::int32_t) * static_cast<unsigned>(count));
}

}  // namespace
}  // namespace render::shade
