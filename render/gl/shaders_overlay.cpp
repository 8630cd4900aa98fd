#include "render/gl/shaders.h"

namespace render::gl {

const char* const kOverlayVertex = R"(
layout(location = 0) in vec3 clip;        // x, y in pixels from the lower left, z depth 0..1
layout(location = 1) in vec4 tint;
layout(location = 2) in vec3 shape;       // across, along: pixels from the middle line; half width
layout(location = 3) in vec2 extent;      // length; 1: ends cut square, 0: rounded
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

const char* const kOverlayFragment = R"(
in vec4 tint_f;
in vec3 shape_f;
in vec2 extent_f;
out vec4 pixel;
void main() {
  // distance to a capsule, or to a piece cut square, of the given half width: analytic anti-aliasing
  float beyond = max(-shape_f.y, shape_f.y - extent_f.x);
  float d = extent_f.y > 0.5 ? max(abs(shape_f.x) - shape_f.z, beyond) : length(vec2(shape_f.x, max(beyond, 0.0))) - shape_f.z;
  float cover = clamp(0.5 - d, 0.0, 1.0);
  if (cover <= 0.0) discard;
  pixel = vec4(tint_f.rgb, tint_f.a * cover);
}
)";

}  // namespace render::gl
