#include "render/gl/shaders.h"

namespace render::gl {

const char* const kStripVertex = R"(
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 cross_dark_along;
out vec3 strip;
out vec2 place;
void main() {
  strip = cross_dark_along;
  place = position.xy;
  gl_Position = world_to_clip * vec4(position, 1.0);
}
)";
const char* const kStripFragment = R"(
uniform sampler2D noise_map;
in vec3 strip;
in vec2 place;
out vec4 colour;
void main() {
  float w = max(fwidth(strip.x), 1e-4);
  float edge = clamp((1.0 - abs(strip.x)) / max(w, 0.22), 0.0, 1.0);
  vec2 foot = fwidth(place);
  float rough = 0.75 + 0.9 * (textureLod(noise_map, place / 1.07, 0.0).r - 0.5) * clamp(1.4 - 67.0 * max(foot.x, foot.y), 0.0, 1.0);
  // ribs of the tread run along the mark
  float ribs = mix(0.80 + 0.20 * cos(strip.x * 12.0), 0.8, smoothstep(0.15, 0.5, w));
  float dark = clamp(strip.y * edge * rough * ribs, 0.0, 1.0) * 0.8;
  colour = vec4(vec3(0.0402), dark);  // rubber: 0.012 on the tone curve
}
)";

}  // namespace render::gl
