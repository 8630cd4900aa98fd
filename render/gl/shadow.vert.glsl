// Corners as in object.vert.glsl; the depth map is all that is drawn.
layout(location = 0) in vec4 corner;
uniform float per_viewport;
void main() {
  gl_Position = vec4(corner.xy * per_viewport - corner.w, 2.0 * corner.z - corner.w, corner.w);
}
