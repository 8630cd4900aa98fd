#include "render/gl/shaders.h"

namespace render::gl {

// mirrors struct FrameBlock in frame_block.h, std140
const char* const kFrameBlock = R"(
layout(std140) uniform Frame {
  mat4 world_to_clip;
  mat4 clip_to_world;
  vec4 eye;               // xyz; w: 1 orthographic
  vec4 forward;           // xyz view direction
  vec4 sun;               // xyz towards the sun; w: haze 0..1
  vec4 ground;            // x height, y road half width, z road centre, w lanes
  vec4 road;              // x road, y metre grid, z zebra, w zebra position
  vec4 frame;             // xy two over the picture's width and height
  vec4 near_0, near_x, near_y;  // a pixel's ray from here ...
  vec4 far_0, far_x, far_y;     // ... to here: at the corner, and per pixel right and up
  mat4 world_to_shadow;   // to 0..1
  vec4 shadow;            // xy one texel in metres, z depth range in metres, w width of penumbra filter in metres
  vec4 shadow_size;       // xy extent of the map in metres
  vec4 occlusion;         // the occlusion map's place: xy lowest corner, zw size [m]
  ivec4 counts;           // x round occluders, y boxes
  vec4 round_rows[72];    // three rows of world -> unit sphere each
  vec4 box_rows[24];      // three rows of world -> box axes each (metres)
  vec4 box_half[8];       // half widths [m]
};
)";

const char* const kCommon = R"(
uniform sampler2D noise_map;
uniform sampler2DShadow shadow_map;    // the nearest four depths, filtered
uniform sampler2D shadow_depth;
uniform sampler2D shadow_bounds;       // least and largest depth within the filter's reach
uniform sampler2D occlusion_map;

const vec3 kSunLight = vec3(1.95, 1.83, 1.63);
const vec3 kZenith = vec3(0.24, 0.41, 0.68);
const vec3 kHorizon = vec3(0.78, 0.84, 0.90);

vec3 haze_colour() { return mix(kHorizon, vec3(0.80, 0.82, 0.84), sun.w); }

// sky: blue overhead, white towards the horizon, a glow around the sun
vec3 sky_light(vec3 d) {
  float up = max(d.z, 0.0);
  vec3 blue = mix(kZenith, vec3(0.55, 0.60, 0.66), 0.75 * sun.w);
  float band = exp(-up * mix(5.5, 3.0, sun.w));
  vec3 c = mix(blue, haze_colour(), band);
  float s = max(dot(d, sun.xyz), 0.0);
  float s2 = s * s, s4 = s2 * s2, s8 = s4 * s4;
  return c + vec3(1.0, 0.86, 0.65) * (0.30 * s8 * s8 * s8 + 0.12 * s4 * s);
}

// what a mirror sees: sky above, a dim far edge of the land, asphalt below
vec3 surroundings(vec3 d) {
  vec3 below = mix(vec3(0.21, 0.205, 0.20), haze_colour() * 0.55, exp(-6.0 * max(-d.z, 0.0)));
  vec3 c = mix(below, sky_light(d), smoothstep(-0.02, 0.03, d.z));
  float land = smoothstep(-0.05, 0.0, d.z) * (1.0 - smoothstep(0.05, 0.16, d.z));
  return mix(c, vec3(0.17, 0.19, 0.19), 0.55 * land);
}

// light of the half sphere around n, without the sun
vec3 ambient_light(vec3 n, float near_ground) {
  vec3 above = mix(vec3(0.36, 0.43, 0.53), vec3(0.47, 0.49, 0.50), sun.w);
  vec3 below = vec3(0.19, 0.18, 0.165) * near_ground;
  return mix(below, above, 0.5 + 0.5 * n.z);
}

float haze_at(float distance_m) { return 1.0 - exp(-distance_m * mix(0.0015, 0.018, sun.w * sun.w)); }

// Filmic curve (Narkowicz 2015, fit of the ACES reference) of 0.72 c, then sRGB: both in one, as a rational function of sqrt(c) that
// stays within 0.45 / 255 of them up to c = 10, where they reach white.
vec3 to_screen(vec3 c) {
  vec3 s = sqrt(clamp(c, 0.0, 10.0));
  vec3 p = 0.00145106685 + s * (-0.187896814 + s * (6.04647127 + s * (-34.9294162 + s * 67.172244)));
  vec3 q = 1.0 + s * (-7.33100167 + s * (22.7312445 + s * (-39.779932 + s * 67.3452571)));
  return p / q;
}

// half a step of noise hides the steps of eight bits in the sky
float dither() { return (fract(52.9829189 * fract(dot(gl_FragCoord.xy, vec2(0.06711056, 0.00583715)))) - 0.5) / 255.0; }

#if SHADOW == 2
const int kBlockers = 14, kFilter = 24;
#else
const int kBlockers = 8, kFilter = 12;
#endif

#if SHADOW > 0
// Contact hardening: the farther the blocker, the wider the filter (Fernando 2005). llvmpipe runs both sides of an `if` and the first
// turn of a loop, but leaves the loop when no pixel is left in it: blockers are looked for only where the least and largest depth
// around leave it open, the filter runs only where some are found and some are not.
const float kWidest = WIDEST;     // [m] radius of the penumbra filter
const float kSunSpread = 0.030;   // [rad] wider than the true 0.0093: a hazy sun reads better
const mat2 kTurn = mat2(-0.7373688, 0.6754903, -0.6754903, -0.7373688);  // the golden angle: places spread evenly over a disc
// `wanted` 0: no work
float sunlight(vec3 p, vec3 n, float wanted) {
  vec3 at = (world_to_shadow * vec4(p + n * 1.5 * max(shadow.x, shadow.y), 1.0)).xyz;
  at.z = min(at.z, 1.0);
  vec2 bounds = textureLod(shadow_bounds, at.xy, 0.0).xy;
  int open = wanted > 0.5 && at.z > bounds.x && at.z <= bounds.y ? kBlockers : 0;
#if SHADOW == 2
  float turn = 6.2831853 * fract(52.9829189 * fract(dot(gl_FragCoord.xy, vec2(0.06711056, 0.00583715))));
  vec2 start = vec2(cos(turn), sin(turn));
#else
  vec2 start = vec2(1.0, 0.0);
#endif
  vec2 widest = kWidest / shadow_size.xy, d = start;
  float blocker = 0.0, found = 0.0;
  for (int i = 0; i < open; ++i) {
    float z = textureLod(shadow_depth, at.xy + sqrt((float(i) + 0.5) / float(kBlockers)) * d * widest, 0.0).r;
    float hit = step(z, at.z - 0.0002);
    blocker += z * hit;
    found += hit;
    d = kTurn * d;
  }
  float gap = (at.z - blocker / max(found, 1.0)) * shadow.z;
  vec2 spread = clamp(gap * kSunSpread, 1.2 * max(shadow.x, shadow.y), kWidest) / shadow_size.xy;
  int edge = found > 0.5 && found < float(kBlockers) - 0.5 ? kFilter : 0;
  float lit = open > 0 ? step(found, 0.5) : step(at.z, bounds.x), sum = 0.0;
  d = start;
  for (int i = 0; i < edge; ++i) {
    sum += textureLod(shadow_map, vec3(at.xy + sqrt((float(i) + 0.5) / float(kFilter)) * d * spread, at.z), 0.0);
    d = kTurn * d;
  }
  return edge > 0 ? sum / float(kFilter) : lit;
}
#else
float sunlight(vec3 p, vec3 n, float wanted) { return 1.0; }
#endif
)";

const char* const kTileVertex = R"(
layout(location = 0) in vec2 corner;   // pixels
uniform float depth;                   // 0..1
void main() { gl_Position = vec4(corner * frame.xy - 1.0, depth * 2.0 - 1.0, 1.0); }
)";

const char* const kCopyVertex = R"(
void main() { gl_Position = vec4(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0, 0.0, 1.0); }
)";
const char* const kDepthVertex = R"(
layout(location = 0) in vec3 position;
uniform mat4 model_to_clip;
void main() { gl_Position = model_to_clip * vec4(position, 1.0); }
)";
const char* const kDepthFragment = R"(
out vec4 colour;
void main() { colour = vec4(0.0); }
)";

}  // namespace render::gl
