// Visibility buffer: the number of the triangle that a sample sees.
flat in int name;
layout(location = 0) out int triangle;

#ifdef GLASS
uniform int kept;  // of two by two samples, bit 2 y + x: those the pane does not let through
#endif

#ifdef WIRES
in vec3 on_sphere;
// Parallels and meridians every 20 degrees, about two samples wide.
bool on_wire() {
  vec3 u = normalize(on_sphere), dx = dFdx(u), dy = dFdy(u);
  // the derivative of the longitude jumps at its cut, that of its sine and cosine does not
  float rho = sqrt(max(dot(u.xy, u.xy), 1e-4));
  float per_longitude = length(vec2(u.x * dx.y - u.y * dx.x, u.x * dy.y - u.y * dy.x)), per_height = length(vec2(dx.z, dy.z));
  const float turn = 0.34906585;  // [rad] 20 degrees
  float longitude = atan(u.y, u.x) / turn, latitude = asin(clamp(u.z, -1.0, 1.0)) / turn;
  float off_meridian = abs(sin((longitude - round(longitude)) * turn)) * rho * rho / max(per_longitude, 1e-6);
  float off_parallel = abs(u.z - sin(round(latitude) * turn)) / max(per_height, 1e-6);
  return off_parallel <= 1.1 || (off_meridian <= 1.1 && rho >= 0.1);
}
#endif

void main() {
#ifdef GLASS
  ivec2 at = ivec2(gl_FragCoord.xy) & 1;
  if ((kept >> (2 * at.y + at.x) & 1) == 0) discard;
#endif
#ifdef WIRES
  if (!on_wire()) discard;
#endif
  triangle = name;
}
