#include "render/gl/shaders.h"

namespace render::shaders {

const char* const kCommon = R"(#version 330 core
uniform vec3 sun;              // unit, towards the sun
uniform float haze;
uniform vec3 eye;
uniform mat4 world_to_shadow;
uniform sampler2DShadow shadow_map;
uniform float shadow_texel;    // 1 / size
uniform int shadow_taps;       // 4, 12 or 32
uniform float shadow_blur;     // in texels
uniform float ground_height;

const vec3 kSunLight = vec3(3.1, 2.9, 2.6);

// Sky by direction: a clear gradient that pales towards the horizon, warm around the sun.
vec3 sky_colour(vec3 d) {
  float up = max(d.z, 0.0);
  vec3 zenith = mix(vec3(0.16, 0.30, 0.58), vec3(0.42, 0.50, 0.60), haze);
  vec3 horizon = mix(vec3(0.66, 0.76, 0.86), vec3(0.74, 0.78, 0.82), haze);
  vec3 sky = mix(horizon, zenith, pow(1.0 - pow(1.0 - up, 3.0), 0.75));
  float s = max(dot(d, sun), 0.0);
  sky += vec3(1.0, 0.85, 0.6) * (0.12 * pow(s, 12.0) + 0.05 * pow(s, 3.0));
  return sky;
}

vec3 surroundings(vec3 d) {   // what a mirror sees: sky above, road below
  vec3 ground = vec3(0.13, 0.13, 0.125);
  return mix(ground, sky_colour(vec3(d.xy, max(d.z, 0.0))), smoothstep(-0.06, 0.03, d.z));
}

vec3 ambient(vec3 n) {
  vec3 above = mix(vec3(0.42, 0.52, 0.66), vec3(0.55, 0.58, 0.62), haze);
  vec3 below = vec3(0.16, 0.15, 0.14);
  return mix(below, above, 0.5 + 0.5 * n.z);
}

const vec2 kDisc[16] = vec2[](
  vec2(-0.94, -0.40), vec2(0.95, -0.77), vec2(-0.09, -0.93), vec2(0.34, 0.29), vec2(-0.92, 0.46), vec2(-0.82, -0.88),
  vec2(-0.38, 0.28), vec2(0.97, 0.76), vec2(0.44, -0.97), vec2(0.54, -0.47), vec2(-0.26, -0.42), vec2(0.79, 0.19),
  vec2(-0.24, 0.99), vec2(-0.81, 0.91), vec2(0.20, 0.79), vec2(0.14, -0.14));

float lit(vec3 world, float bias) {
  vec4 s = world_to_shadow * vec4(world, 1.0);
  vec3 p = s.xyz * 0.5 + 0.5;
  if (any(lessThan(p, vec3(0.0))) || any(greaterThan(p, vec3(1.0)))) return 1.0;
  float sum = 0.0;
  // a fixed turn per pixel breaks up banding without noise from frame to frame
  float turn = 6.2832 * fract(52.9829 * fract(dot(gl_FragCoord.xy, vec2(0.06711056, 0.00583715))));
  mat2 rotate = mat2(cos(turn), sin(turn), -sin(turn), cos(turn));
  int taps = min(shadow_taps, 16);
  for (int i = 0; i < taps; ++i)
    sum += texture(shadow_map, vec3(p.xy + rotate * kDisc[i] * shadow_blur * shadow_texel, p.z - bias));
  return sum / float(taps);
}

vec3 finish(vec3 colour, float distance) {
  // haze, then a filmic curve (Hable's form with its own constants), then sRGB
  float fog = 1.0 - exp(-distance * (0.0012 + 0.006 * haze * haze));
  colour = mix(colour, vec3(0.70, 0.75, 0.80), fog);
  colour *= 0.92;
  vec3 x = max(colour, vec3(0.0));
  vec3 y = (x * (2.51 * x + 0.03)) / (x * (2.43 * x + 0.59) + 0.14);
  y = clamp(y, 0.0, 1.0);
  return mix(12.92 * y, 1.055 * pow(y, vec3(1.0 / 2.4)) - 0.055, step(0.0031308, y));
}
)";

const char* const kObjectVertex = R"(#version 330 core
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
uniform mat4 model;
uniform mat4 view;
uniform mat4 projection;
out vec3 world;
out vec3 normal_W;
out vec3 local;
void main() {
  vec4 w = model * vec4(position, 1.0);
  world = w.xyz;
  local = position;
  normal_W = mat3(model) * normal;
  gl_Position = projection * view * w;
}
)";

const char* const kObjectFragment = R"(
in vec3 world;
in vec3 normal_W;
in vec3 local;
uniform int kind;              // MaterialKind
uniform vec3 colour;
uniform float roughness;
uniform float opacity;
uniform int raster;
uniform vec3 axes;             // semi-axes, for the raster
uniform vec3 view_direction;   // orthographic: where the camera looks; else zero
out vec4 pixel;

float hash(vec3 p) { return fract(sin(dot(p, vec3(12.9898, 78.233, 37.719))) * 43758.5453); }

void main() {
  vec3 to_eye = eye - world;
  float distance = length(to_eye);
  vec3 v = view_direction == vec3(0.0) ? to_eye / distance : -view_direction;
  vec3 n = normalize(normal_W);
  if (dot(n, v) < 0.0 && !gl_FrontFacing) n = -n;
  if (raster == 1) {
    // parallels and meridians of the hyper-ellipsoid, as wires
    vec3 u = normalize(local / axes);
    vec2 lines = vec2(atan(u.y, u.x), asin(clamp(u.z, -1.0, 1.0))) * (9.0 / 3.14159);
    vec2 d = abs(fract(lines - 0.5) - 0.5) / max(fwidth(lines), vec2(1e-5));
    if (min(d.x, d.y) > 1.0) discard;
  }
  float sunny = max(dot(n, sun), 0.0);
  float shadow = sunny > 0.0 ? lit(world + 0.012 * n, 0.0006) : 0.0;
  float facing = max(dot(n, v), 0.0);
  vec3 h = normalize(v + sun);
  vec3 r = reflect(-v, n);
  // near the ground less of the sky is seen
  float open = mix(0.55, 1.0, smoothstep(0.0, 0.9, world.z - ground_height + 0.6 * n.z));
  vec3 base = colour;
  float gloss = 0.0, mirror_0 = 0.04, sharp = 2.0 / max(roughness * roughness * roughness * roughness, 1e-4);
  float alpha = opacity;
  if (kind == 1) { gloss = 0.55; sharp = 900.0; }                                   // paint under clear coat
  else if (kind == 2) { gloss = 0.9; sharp = 1500.0; mirror_0 = 0.06; }             // glass
  else if (kind == 3) { gloss = 0.7; sharp = 500.0; mirror_0 = 0.12; base *= 1.15; } // lamp
  else if (kind == 4) { base *= 0.9; gloss = 0.06; sharp = 18.0; }                  // rubber
  else if (kind == 5) { gloss = 0.9; mirror_0 = 0.5; sharp = 120.0; }               // metal
  else if (kind == 6) { base *= mix(vec3(1.0), vec3(1.06, 0.96, 0.92), 1.0 - facing); gloss = 0.12; sharp = 24.0; }   // skin
  else if (kind == 7) { base *= 0.96 + 0.08 * hash(floor(local * 420.0)); base *= 1.0 + 0.10 * pow(1.0 - facing, 3.0); }   // cloth
  else { gloss = 0.12 * (1.0 - roughness); }
  float fresnel = mirror_0 + (1.0 - mirror_0) * pow(1.0 - facing, 5.0);
  float wrap = kind == 6 || kind == 7 ? max((dot(n, sun) + 0.12) / 1.12, 0.0) : sunny;
  vec3 light = kSunLight * wrap * shadow + ambient(n) * open * 1.1;
  vec3 metal_tint = kind == 5 ? colour : vec3(1.0);
  vec3 c = base * light * (kind == 5 ? 0.35 : 1.0) / 3.14159 * 1.55;
  c += surroundings(r) * fresnel * gloss * metal_tint * mix(0.5, 1.0, open);
  float spec = pow(max(dot(n, h), 0.0), sharp) * (sharp + 8.0) / 25.0;
  c += kSunLight * spec * shadow * sunny * gloss * mirror_0 * 2.0;
  if (kind == 2) alpha = clamp(mix(opacity, 1.0, fresnel) + spec * 0.2, 0.0, 1.0);
  pixel = vec4(finish(c, view_direction == vec3(0.0) ? distance : 5.0), alpha);
}
)";

const char* const kShadowVertex = R"(#version 330 core
layout(location = 0) in vec3 position;
uniform mat4 model;
uniform mat4 world_to_shadow;
void main() { gl_Position = world_to_shadow * (model * vec4(position, 1.0)); }
)";

const char* const kShadowFragment = R"(#version 330 core
void main() {}
)";

const char* const kBackgroundVertex = R"(#version 330 core
out vec2 at;
void main() {
  at = vec2(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0);
  gl_Position = vec4(at, 0.999999, 1.0);
}
)";

const char* const kBackgroundFragment = R"(
in vec2 at;
uniform mat4 clip_to_world;
uniform vec3 view_direction;      // orthographic: where the camera looks; else zero
uniform vec2 pixel_size;          // of the frame, 2 / pixels
uniform int road;
uniform float road_width;
uniform float road_centre;
uniform int lanes;
uniform int metre_grid;
uniform int zebra;
uniform float zebra_x;
uniform int occluders;
uniform vec4 occluder[32];        // centre, radius
uniform int boxes;
uniform mat4 box_from_world[4];
uniform vec3 box_half[4];
out vec4 pixel;

float hash(vec2 p) { return fract(sin(dot(p, vec2(127.1, 311.7))) * 43758.5453); }
float noise(vec2 p) {
  vec2 i = floor(p), f = fract(p);
  f = f * f * (3.0 - 2.0 * f);
  return mix(mix(hash(i), hash(i + vec2(1, 0)), f.x), mix(hash(i + vec2(0, 1)), hash(i + vec2(1, 1)), f.x), f.y);
}
// noise that fades to its mean where its grain is finer than the pixel
float grain(vec2 p, float frequency, float footprint) {
  return 0.5 + (noise(p * frequency) - 0.5) * clamp(1.5 - 1.6 * footprint * frequency, 0.0, 1.0);
}
// share of a pixel of width f around x that lies in [-h, h]
float stripe(float x, float h, float f) {
  f = max(f, 1e-4);
  return clamp((h - x) / f + 0.5, 0.0, 1.0) * clamp((x + h) / f + 0.5, 0.0, 1.0) * min(1.0, 2.0 * h / f + 0.25);
}

vec3 ground_colour(vec2 p, vec2 f) {
  float foot = max(f.x, f.y);
  float small = grain(p, 160.0, foot), middle = grain(p, 34.0, foot), large = grain(p, 0.6, foot), huge = grain(p, 0.11, foot);
  vec3 asphalt = vec3(0.175, 0.176, 0.18) * (0.80 + 0.25 * small + 0.10 * middle + 0.12 * large + 0.08 * huge);
  if (road == 0) {
    vec3 plain = vec3(0.26, 0.26, 0.255) * (0.9 + 0.08 * small + 0.06 * middle + 0.08 * large);
    if (metre_grid == 1) {
      vec2 g = abs(fract(p + 0.5) - 0.5);
      plain = mix(plain, vec3(0.42), 0.5 * max(stripe(g.x, 0.012, f.x), stripe(g.y, 0.012, f.y)));
    }
    return plain;
  }
  float y = p.y - road_centre;
  float half_width = 0.5 * road_width;
  float off = abs(y) - half_width;
  // wheel tracks: a little darker and smoother
  float lane = road_width / float(max(lanes, 1));
  float in_lane = mod(y + half_width, lane) - 0.5 * lane;
  asphalt *= 1.0 - 0.07 * exp(-pow((abs(in_lane) - 0.75) / 0.28, 2.0));
  vec3 paint = vec3(0.62, 0.62, 0.60) * (0.86 + 0.14 * middle);
  float marks = stripe(abs(y) - half_width + 0.25, 0.06, f.y);
  for (int k = 1; k < lanes; ++k) {
    float line = stripe(y + half_width - lane * float(k), 0.06, f.y);
    float dash = mod(p.x, 9.0) - 4.5;
    marks = max(marks, line * stripe(dash, 1.5, f.x));
  }
  if (zebra == 1) marks = max(marks, stripe(p.x - zebra_x, 2.0, f.x) * stripe(mod(y, 1.0) - 0.5, 0.25, f.y) * step(off, -0.3));
  vec3 c = mix(asphalt, paint, marks * 0.92);
  if (metre_grid == 1) {
    vec2 g = abs(fract(p + 0.5) - 0.5);
    c = mix(c, vec3(0.45), 0.30 * max(stripe(g.x, 0.008, f.x), stripe(g.y, 0.008, f.y)));
  }
  // kerb stone, pavement of slabs, grass
  vec3 kerb = vec3(0.36, 0.355, 0.34) * (0.9 + 0.2 * middle);
  vec2 slab = abs(fract(p / 0.6 + 0.5) - 0.5) * 0.6;
  vec3 pavement = vec3(0.33, 0.325, 0.31) * (0.86 + 0.12 * small + 0.12 * large);
  pavement *= 1.0 - 0.35 * max(stripe(slab.x, 0.006, f.x), stripe(slab.y, 0.006, f.y));
  vec3 grass = mix(vec3(0.075, 0.105, 0.042), vec3(0.125, 0.150, 0.065), large) * (0.7 + 0.35 * middle + 0.3 * small);
  float s = max(f.y, 1e-4);
  c = mix(c, kerb, clamp(off / s + 0.5, 0.0, 1.0));
  c = mix(c, pavement, clamp((off - 0.15) / s + 0.5, 0.0, 1.0));
  c = mix(c, grass, clamp((off - 2.15) / s + 0.5, 0.0, 1.0));
  return c;
}

float openness(vec3 p) {
  float open = 1.0;
  for (int i = 0; i < occluders; ++i) {
    vec3 d = occluder[i].xyz - p;
    float l2 = dot(d, d), r = occluder[i].w;
    float cosine = max(d.z, 0.0) * inversesqrt(l2);
    open *= 1.0 - 0.85 * cosine * clamp(r * r / l2, 0.0, 1.0);
  }
  for (int i = 0; i < boxes; ++i) {
    vec3 q = (box_from_world[i] * vec4(p, 1.0)).xyz;
    vec2 d = max(abs(q.xy) - box_half[i].xy, 0.0);
    float inside = min(max(abs(q.x) - box_half[i].x, abs(q.y) - box_half[i].y), 0.0);
    float out_by = length(d) + inside * 0.6;
    float clearance = max(abs(q.z) - box_half[i].z, 0.05);
    open *= 1.0 - 0.82 * (1.0 - smoothstep(-0.55, 0.45, out_by)) * exp(-1.2 * max(clearance - 0.3, 0.0));
  }
  return open;
}

void main() {
  vec4 near = clip_to_world * vec4(at, -1.0, 1.0), far = clip_to_world * vec4(at, 1.0, 1.0);
  vec3 a = near.xyz / near.w, b = far.xyz / far.w;
  vec3 d = normalize(b - a);
  if (view_direction == vec3(0.0)) a = eye;
  vec3 c;
  float distance = 1e4;
  if (d.z < -1e-4) {
    distance = (ground_height - a.z) / d.z;
    vec3 p = a + distance * d;
    vec2 f = fwidth(p.xy);
    // towards the horizon differences run wild: bound them by the analytic footprint
    f = min(f, vec2(distance * pixel_size.y * 1.2 / max(-d.z, 0.002)));
    float shadow = lit(p, 0.0003);
    vec3 albedo = ground_colour(p.xy, f);
    float open = openness(p);
    vec3 light = kSunLight * max(sun.z, 0.0) * shadow * mix(1.0, open, 0.35) + ambient(vec3(0, 0, 1)) * open * 1.1;
    c = albedo * light / 3.14159 * 1.55;
    // grazing sheen
    float grazing = pow(1.0 - min(-d.z, 1.0), 6.0);
    c += sky_colour(vec3(d.xy, -d.z)) * grazing * 0.10 * open;
    if (view_direction != vec3(0.0)) distance = 5.0;
    c = finish(c, max(distance, 0.0));
    float edge = smoothstep(0.0, 0.006, -d.z);
    c = mix(finish(sky_colour(vec3(d.xy, 0.0)) * 0.97, 0.0), c, view_direction == vec3(0.0) ? edge : 1.0);
  } else {
    c = finish(sky_colour(d), 0.0);
    c = mix(finish(sky_colour(vec3(d.xy, 0.0)) * 0.97, 0.0), c, smoothstep(0.0, 0.03, d.z));
  }
  // half a step of noise hides the steps of eight bits in the sky
  c += (fract(52.9829 * fract(dot(gl_FragCoord.xy, vec2(0.06711056, 0.00583715)))) - 0.5) / 255.0;
  pixel = vec4(c, 1.0);
}
)";

const char* const kOverlayVertex = R"(#version 330 core
layout(location = 0) in vec3 clip;        // x, y in pixels from the lower left, z depth 0..1
layout(location = 1) in vec4 tint;
layout(location = 2) in vec3 shape;       // across, along: pixels from the middle line; half width
layout(location = 3) in vec2 extent;      // length, depth-tested
uniform vec2 frame;                       // pixels
out vec4 tint_f;
out vec3 shape_f;
out vec2 extent_f;
void main() {
  tint_f = tint;
  shape_f = shape;
  extent_f = extent;
  gl_Position = vec4(clip.xy / frame * 2.0 - 1.0, clip.z * 2.0 - 1.0, 1.0);
}
)";

const char* const kOverlayFragment = R"(#version 330 core
in vec4 tint_f;
in vec3 shape_f;
in vec2 extent_f;
out vec4 pixel;
void main() {
  // distance to a capsule of the given half width: analytic anti-aliasing
  float along = max(max(-shape_f.y, shape_f.y - extent_f.x), 0.0);
  float d = length(vec2(shape_f.x, along)) - shape_f.z;
  float cover = clamp(0.5 - d, 0.0, 1.0);
  if (cover <= 0.0) discard;
  pixel = vec4(tint_f.rgb, tint_f.a * cover);
}
)";

}  // namespace render::shaders
