#include "render/gl/shaders.h"

namespace render::gl {

// mirrors the beginning of struct FrameBlock in frame_block.h, std140
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
};
)";

}  // namespace render::gl
