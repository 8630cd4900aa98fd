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

}  // namespace render::gl
