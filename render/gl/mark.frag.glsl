// What a mark lets through of the ground: multiplied into what other marks let through.
in vec4 scaled_mark;
in float scaled;
uniform sampler2D noise_map;
layout(location = 0) out float covers;

float grain(vec2 at, float footprint) {
  return (texture(noise_map, at / 1.07).r - 0.5) * clamp(1.4 - footprint * (0.4 * 256.0 / 1.07), 0.0, 1.0);
}

void main() {
  vec4 mark = scaled_mark / scaled;
  vec4 change = abs(dFdx(mark)) + abs(dFdy(mark));
  float width = max(change.x, 1e-4);
  float edge = clamp((1.0 - abs(mark.x)) / max(width, 0.22), 0.0, 1.0);
  float rough = 0.75 + 0.9 * grain(mark.zw, 0.7 * max(change.z, change.w));
  float ribs = mix(0.8 + 0.2 * cos(mark.x * 12.0), 0.8, smoothstep(0.15, 0.5, width));  // of the tread, along the mark
  covers = clamp(mark.y * edge * rough * ribs, 0.0, 1.0) * 0.8;
#ifdef ON_TERRAIN
  float slope = max(abs(dFdx(gl_FragCoord.z)), abs(dFdy(gl_FragCoord.z)));
  covers *= 1.0 - hidden_share(ivec2(gl_FragCoord.xy), gl_FragCoord.z - slope - 2.0 / 16777216.0);
#endif
}
