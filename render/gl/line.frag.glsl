// The distance to a capsule, or to a taper cut square, tells how much of a pixel is covered.
flat in vec4 colour;
noperspective in vec3 at;
noperspective in float depth;
flat in vec2 size;
layout(location = 0) out vec4 premultiplied;
#ifdef BEHIND_THINGS
uniform float occluded;  // share of the opacity that is left behind things
#endif

void main() {
  float beyond = max(-at.y, at.y - size.x);
  float d = size.y > 0.5 ? max(abs(at.x) - at.z, beyond) : length(vec2(at.x, max(beyond, 0.0))) - at.z;
  float alpha = colour.a * clamp(0.5 - d, 0.0, 1.0);
#ifdef BEHIND_THINGS
  alpha *= 1.0 - (1.0 - occluded) * hidden_share(ivec2(gl_FragCoord.xy), clamp(depth, 0.0, 1.0));
#endif
  premultiplied = vec4(colour.rgb * alpha, alpha);
}
