// A corner in samples, scaled to w = 1 where it lies before the eye. All products here are with powers of two: nothing rounds
// differently with fused multiply-add.
layout(location = 0) in vec4 corner;   // x, y [samples], depth 0..1, w
layout(location = 1) in float height;  // [m] above the ground, scaled as the corner is
layout(location = 2) in int number;    // of the triangle
uniform float per_viewport;            // two over the viewport's side, a power of two
flat out int name;
#ifdef WIRES
layout(location = 3) in vec3 place;  // [m] in the ellipsoid, scaled as the corner is
uniform vec3 axes;                   // of the ellipsoid
out vec3 on_sphere;
#endif
void main() {
  gl_Position = vec4(corner.xy * per_viewport - corner.w, 2.0 * corner.z - corner.w, corner.w);
  gl_ClipDistance[0] = height;  // what has sunk into the ground is hidden by it
  name = number;
#ifdef WIRES
  on_sphere = place / axes;
#endif
}
