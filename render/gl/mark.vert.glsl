// Corners of tyre marks, brought to the picture as in object.vert.glsl.
layout(location = 0) in vec4 corner;  // x, y [pixels], depth 0..1, w
layout(location = 1) in float scale;  // what the corner was scaled by
layout(location = 2) in vec4 mark;    // -1..1 from edge to edge; darkness 0..1; place on the ground [m]
uniform float per_viewport;           // two over the viewport's side
out vec4 scaled_mark;
out float scaled;
void main() {
  gl_Position = vec4(corner.xy * per_viewport - corner.w, 2.0 * corner.z - corner.w, corner.w);
  scaled_mark = mark * scale;
  scaled = scale;
}
