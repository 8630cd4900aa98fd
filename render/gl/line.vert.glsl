// Lines, arrows and markers: a rectangle around each piece, in pixels.
layout(location = 0) in vec3 corner;  // [pixels] from the lower left; depth 0..1
layout(location = 1) in vec4 tint;
layout(location = 2) in vec3 shape;   // [pixels] across and along from the piece's beginning; half width
layout(location = 3) in vec2 extent;  // length [pixels]; 1: ends cut square, 0: rounded
uniform float per_viewport;           // two over the viewport's side
flat out vec4 colour;
noperspective out vec3 at;
noperspective out float depth;
flat out vec2 size;
void main() {
  colour = tint;
  at = shape;
  depth = corner.z;
  size = extent;
  gl_Position = vec4(corner.xy * per_viewport - 1.0, 0.0, 1.0);
}
