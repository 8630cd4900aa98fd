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

// Light for what the four samples of a pixel see: once where they see one smooth surface, else each for itself.
const char* const kShadeFragment = R"(
uniform sampler2D seen_map;        // of the object pass, SAMPLES a side to a pixel
uniform sampler2D depth_map;
uniform sampler2D material_map;    // four texels a row
uniform vec2 origin;               // of the object pass, pixels of the picture
out vec4 colour;

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
  float lit = sunlight(p, n, step(0.0, toward));
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
  c = mix(c, paint * sky * 0.12 + 0.004, inside);
  float far_m = eye.w > 0.5 ? 0.0 : length(p - eye.xyz);
  return to_screen(mix(c, haze_colour(), haze_at(far_m)));
}

void main() {
  vec2 pixel = floor(gl_FragCoord.xy);
  ivec2 at = ivec2(pixel - origin) * SAMPLES;
#if SAMPLES == 1
  vec4 s = texelFetch(seen_map, at, 0);
  float depth = texelFetch(depth_map, at, 0).r;
  colour = vec4(light(place_of(pixel + 0.5, depth), normal_of(s.xy), floor(s.z * 65535.0 + 0.5) - 1.0, s.w), 1.0) * step(1e-6, s.z);
#if DEPTH
  gl_FragDepth = depth;
#endif
#else
  vec4 a = texelFetch(seen_map, at, 0), b = texelFetch(seen_map, at + ivec2(1, 0), 0);
  vec4 c = texelFetch(seen_map, at + ivec2(0, 1), 0), d = texelFetch(seen_map, at + ivec2(1, 1), 0);
  vec3 na = normal_of(a.xy), nb = normal_of(b.xy), nc = normal_of(c.xy), nd = normal_of(d.xy);
  vec4 za = vec4(texelFetch(depth_map, at, 0).r, texelFetch(depth_map, at + ivec2(1, 0), 0).r,
                 texelFetch(depth_map, at + ivec2(0, 1), 0).r, texelFetch(depth_map, at + ivec2(1, 1), 0).r);
  bool same = a.z == b.z && a.z == c.z && a.z == d.z && min(dot(na, nd), dot(nb, nc)) > 0.95;
  float empty = 1.0 - step(1e-6, a.z + b.z + c.z + d.z);
  vec3 n = normalize(na + nb + nc + nd);
  float depth = dot(za, vec4(0.25));
  int count = empty > 0.5 ? 0 : same ? 1 : 4;
  vec4 sum = vec4(0.0);
  // a loop is left when no pixel is left in it; it does not run for what is alike
  for (int i = 0; i < count; ++i) {
    vec4 s = i == 0 ? a : i == 1 ? b : i == 2 ? c : d;
    vec3 m = i == 0 ? na : i == 1 ? nb : i == 2 ? nc : nd;
    float z = i == 0 ? za.x : i == 1 ? za.y : i == 2 ? za.z : za.w;
    vec2 inside = vec2(0.25 + 0.5 * float(i & 1), 0.25 + 0.5 * float(i >> 1));
    vec3 p = same ? place_of(pixel + 0.5, depth) : place_of(pixel + inside, z);
    sum += vec4(light(p, same ? n : m, floor(s.z * 65535.0 + 0.5) - 1.0, same ? 0.25 * (a.w + b.w + c.w + d.w) : s.w), 1.0) * step(1e-6, s.z);
  }
  colour = sum / max(same ? 1.0 : 4.0, 1.0);
#if DEPTH
  gl_FragDepth = min(min(za.x, za.y), min(za.z, za.w));
#endif
#endif
}
)";

}  // namespace render::gl
