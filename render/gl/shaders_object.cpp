#include "render/gl/shaders.h"

namespace render::gl {

const char* const kObjectVertex = R"(
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
uniform mat4 model;
out vec3 at_W;
out vec3 at_M;
out vec3 normal_W;
void main() {
  vec4 p = model * vec4(position, 1.0);
  at_W = p.xyz;
  at_M = position;
  normal_W = mat3(model) * normal;
  gl_Position = world_to_clip * p;
  // what has sunk into the ground is hidden by it
  gl_ClipDistance[0] = p.z - ground.x;
}
)";

// What is seen, not how it is lit: normal on the octahedron (16 bits each), material, grain. KIND follows enum MaterialKind: matte
// 0, paint 1, glass 2, lamp 3, rubber 4, metal 5, skin 6, cloth 7; 8 is terrain, 9 a wire grid. SHELL: only front faces arrive.
const char* const kObjectFragment = R"(
in vec3 at_W;
in vec3 at_M;
in vec3 normal_W;
uniform float material;  // row of the table
uniform float opacity;
uniform float closed;    // 1: outside is counter-clockwise, -1: clockwise, 0: a sheet
uniform vec3 axes;       // semi-axes of an ellipsoid drawn as a wire grid
out vec4 seen;

// transparency by samples: of four neighbours so many stay as the opacity says, wherever the picture's pixel lies
bool left_out(float alpha) {
  ivec2 i = ivec2(gl_FragCoord.xy) & 1;
  return alpha < (float((i.x ^ i.y) * 2 + i.y) + 0.5) / 4.0;
}

vec2 octahedron(vec3 n) {
  n /= abs(n.x) + abs(n.y) + abs(n.z);
  vec2 folded = (1.0 - abs(n.yx)) * vec2(n.x < 0.0 ? -1.0 : 1.0, n.y < 0.0 ? -1.0 : 1.0);
  return 0.5 + 0.5 * (n.z < 0.0 ? folded : n.xy);
}

void main() {
  vec3 n = normalize(normal_W);
  float id = material, grain = 0.5;
#if !SHELL
  // whatever the file's winding and normals, light the side that is seen
  vec3 v = eye.w > 0.5 ? -forward.xyz : eye.xyz - at_W;
  vec3 face = cross(dFdx(at_W), dFdy(at_W));
  face = dot(face, v) < 0.0 ? -face : face;
  n = dot(n, face) < 0.0 ? -n : n;
  id += closed * (gl_FrontFacing ? 1.0 : -1.0) < -0.5 ? 32768.0 : 0.0;  // the inside of a body
#endif
#if KIND == 2
  if (left_out(opacity)) discard;
#elif KIND == 3
  // ribs of a reflector under clear plastic
  n = normalize(n + 0.25 * vec3(0.0, sin(at_M.y * 160.0), cos(at_M.z * 130.0)) *
                        (1.0 - smoothstep(0.2, 0.8, fwidth(at_M.y * 25.0) + fwidth(at_M.z * 20.0))));
#elif KIND == 7
  grain = 0.5 + 0.25 * sin(at_M.x * 31.0 + 2.0 * sin(at_M.z * 23.0)) * sin(at_M.y * 37.0 + 2.0 * sin(at_M.x * 17.0 + at_M.z * 9.0));
#elif KIND == 9
  // parallels and meridians every 20 degrees
  vec3 u = normalize(at_M / axes);
  vec2 grid = vec2(atan(u.y, u.x), asin(clamp(u.z, -1.0, 1.0))) * (9.0 / 3.14159);
  // the derivative of the longitude jumps at its cut, that of its sine and cosine does not
  vec3 dx = dFdx(u), dy = dFdy(u);
  float rho2 = max(dot(u.xy, u.xy), 1e-4);
  vec2 per_pixel = vec2(length(vec2(u.x * dx.y - u.y * dx.x, u.x * dy.y - u.y * dy.x)) / rho2, length(vec2(dx.z, dy.z)) / sqrt(rho2)) * (9.0 / 3.14159);
  vec2 off = abs(fract(grid + 0.5) - 0.5) / max(per_pixel, vec2(1e-5));
  if (min(off.x, off.y) > 1.1 || (rho2 < 0.01 && off.y > 1.1)) discard;
#endif
  seen = vec4(octahedron(n), (id + 1.0) / 65535.0, grain);
}
)";

// Depth of the nearest sample of a pixel.
const char* const kSeenDepthFragment = R"(
uniform sampler2D depth_map;
uniform vec2 origin;
void main() {
  ivec2 at = ivec2(floor(gl_FragCoord.xy) - origin) * SAMPLES;
  float nearest = 1.0;
  for (int i = 0; i < SAMPLES * SAMPLES; ++i) nearest = min(nearest, texelFetch(depth_map, at + ivec2(i % SAMPLES, i / SAMPLES), 0).r);
  gl_FragDepth = nearest;
}
)";

// For the two shaders below.
const char* const kSurfaces = R"(
uniform sampler2D seen_map;        // of the object pass, SAMPLES a side to a pixel
uniform vec2 origin;               // of the object pass, pixels of the picture
out vec4 colour;

// The samples of a pixel, and which of them show the first surface that is seen, which another: nearly no pixel shows three.
struct Seen {
  vec4 a, b, c, d;
  vec4 first, second;   // a sample of each
  vec4 one, rest;       // 1 where a sample shows the first surface, another one
};

// one surface: the same material, normals within some 15 degrees. At the octahedron's folds a surface may look like two; that costs
// time alone
float alike(vec4 a, vec4 b) { return a.z == b.z && max(abs(a.x - b.x), abs(a.y - b.y)) < 0.07 ? 1.0 : 0.0; }

Seen look(ivec2 at) {
  Seen s;
  s.a = texelFetch(seen_map, at, 0);
#if SAMPLES == 1
  s.one = vec4(step(1e-6, s.a.z), 0.0, 0.0, 0.0);
  s.rest = vec4(0.0);
  s.b = s.c = s.d = s.first = s.second = s.a;
#else
  s.b = texelFetch(seen_map, at + ivec2(1, 0), 0);
  s.c = texelFetch(seen_map, at + ivec2(0, 1), 0);
  s.d = texelFetch(seen_map, at + ivec2(1, 1), 0);
  vec4 full = step(1e-6, vec4(s.a.z, s.b.z, s.c.z, s.d.z));
  s.first = full.x > 0.5 ? s.a : full.y > 0.5 ? s.b : full.z > 0.5 ? s.c : s.d;
  s.one = full * vec4(alike(s.first, s.a), alike(s.first, s.b), alike(s.first, s.c), alike(s.first, s.d));
  s.rest = full - s.one;
  s.second = s.rest.y > 0.5 ? s.b : s.rest.z > 0.5 ? s.c : s.d;
#endif
  return s;
}
)";

// How many surfaces the samples of a pixel show, as a depth: 0, 0.5 or 1; and the share of the pixel they cover.
const char* const kCountFragment = R"(
void main() {
  Seen s = look(ivec2(floor(gl_FragCoord.xy) - origin) * SAMPLES);
  colour = vec4(dot(s.one + s.rest, vec4(1.0 / float(SAMPLES * SAMPLES))));
  gl_FragDepth = 0.5 * (step(0.5, dot(s.one, s.one)) + step(0.5, dot(s.rest, s.rest)));
}
)";

// Light of the first surface of a pixel, or of the second.
const char* const kShadeFragment = R"(
uniform sampler2D depth_map;
uniform sampler2D material_map;    // four texels a row

vec3 normal_of(vec2 f) {
  f = f * 2.0 - 1.0;
  vec3 n = vec3(f, 1.0 - abs(f.x) - abs(f.y));
  float t = max(-n.z, 0.0);
  n.xy += vec2(n.x < 0.0 ? t : -t, n.y < 0.0 ? t : -t);
  return normalize(n);
}

vec3 place_of(vec2 pixel, float depth) {
  vec4 p = clip_to_world * vec4(pixel * frame.xy - 1.0, depth * 2.0 - 1.0, 1.0);
  return p.xyz / p.w;
}

// highlight of the sun, Blinn-Phong normalised
float shine(float cosine, float exponent) { return (exponent + 8.0) / 25.13 * pow(cosine, exponent); }

vec3 light(vec3 p, vec3 n, float id, float grain) {
  float inside = step(32767.5, id);
  int row = int(id - 32768.0 * inside + 0.5);
  vec4 base = texelFetch(material_map, ivec2(0, row), 0);    // rgb, diffuse share
  vec4 coat = texelFetch(material_map, ivec2(1, row), 0);    // reflection straight on and at grazing, tinted mirror, glow
  vec4 lobes = texelFetch(material_map, ivec2(2, row), 0);   // broad tinted highlight: strength, exponent; sharp white one
  vec4 soft = texelFetch(material_map, ivec2(3, row), 0);    // wrap, sheen, grain, terrain
  vec3 v = eye.w > 0.5 ? -forward.xyz : normalize(eye.xyz - p);
  float toward = dot(n, sun.xyz), ndl = max(toward, 0.0), ndv = clamp(dot(n, v), 0.0, 1.0);
  float lit = sunlight(p, n, step(-soft.x, toward));
  float height = p.z - ground.x;
  vec3 sky = ambient_light(n, mix(0.30, 1.0, smoothstep(0.0, 0.9, height))) * mix(0.62, 1.0, smoothstep(-0.05, 0.45, height));
  vec3 r = reflect(-v, n);
  // a mirror close to the road sees the car's own shade under it
  vec3 mirror = surroundings(r) * mix(mix(0.35, 1.0, smoothstep(0.0, 0.8, height)), 1.0, step(0.0, r.z));
  float away = 1.0 - ndv, fresnel = away * away * away * away * away;
  float reflects = coat.x + coat.y * fresnel;
  vec3 paint = base.rgb * (1.0 + soft.z * (grain - 0.5));
#if TERRAIN
  vec2 foot = fwidth(p.xy);
  paint = mix(paint, ground_colour(p.xy, clamp(foot, vec2(1e-4), vec2(1e3))), soft.w);
#endif
  // light goes a little way round into skin and comes out warmer
  float wrapped = max((toward + soft.x) / (1.0 + soft.x), 0.0);
  vec3 sunny = mix(vec3(ndl), vec3(wrapped, mix(ndl, wrapped, 0.45), mix(ndl, wrapped, 0.3)), step(0.001, soft.x));
  vec3 c = paint * (base.a * (kSunLight * sunny * lit + sky) * (1.0 - reflects) + soft.y * fresnel * sky + coat.z * mirror + coat.w);
  float half_cosine = max(dot(n, normalize(sun.xyz + v)), 0.0);
  c += reflects * mirror;
  c += kSunLight * lit * ndl * (paint * lobes.x * shine(half_cosine, lobes.y) + lobes.z * shine(half_cosine, lobes.w));
  c = mix(c, paint * sky * 0.25 + 0.006, inside);
  float far_m = eye.w > 0.5 ? 0.0 : length(p - eye.xyz);
  return to_screen(mix(c, haze_colour(), haze_at(far_m)));
}

void main() {
  vec2 pixel = floor(gl_FragCoord.xy);
  ivec2 at = ivec2(pixel - origin) * SAMPLES;
  Seen s = look(at);
#if SAMPLES == 1
  vec4 mean = s.a;
  vec3 p = place_of(pixel + 0.5, texelFetch(depth_map, at, 0).r);
  float share = s.one.x;
#else
#if SECOND
  vec4 w = s.rest * vec4(0.0, alike(s.second, s.b), alike(s.second, s.c), alike(s.second, s.d));
  float share = dot(s.rest, vec4(0.25)), id = s.second.z;
#else
  vec4 w = s.one;
  float share = dot(s.one, vec4(0.25)), id = s.first.z;
#endif
  w /= max(dot(w, vec4(1.0)), 1.0);
  vec4 z = vec4(texelFetch(depth_map, at, 0).r, texelFetch(depth_map, at + ivec2(1, 0), 0).r,
                texelFetch(depth_map, at + ivec2(0, 1), 0).r, texelFetch(depth_map, at + ivec2(1, 1), 0).r);
  vec4 mean = w.x * s.a + w.y * s.b + w.z * s.c + w.w * s.d;
  mean.z = id;
  vec3 p = place_of(pixel + 0.25 + 0.5 * vec2(w.y + w.w, w.z + w.w), dot(z, w));
#endif
  colour = share > 0.0 ? share * vec4(light(p, normal_of(mean.xy), floor(mean.z * 65535.0 + 0.5) - 1.0, mean.w), 1.0) : vec4(0.0);
}
)";

}  // namespace render::gl
