#include "render/gl/shaders.h"

namespace render::gl {

const char* const kGroundPattern = R"(
// part of a footprint w around x that a bar of half width h at c covers
float bar(float x, float c, float h, float w) { return clamp((min(x + 0.5 * w, c + h) - max(x - 0.5 * w, c - h)) / w, 0.0, 1.0); }

// the same for bars repeated with a period, exact for any footprint
float bars(float x, float period, float h, float w) {
  float a = (x - 0.5 * w) / period, b = (x + 0.5 * w) / period, r = h / period;
  float ia = floor(a + 0.5) * 2.0 * r + clamp(a - floor(a + 0.5), -r, r);
  float ib = floor(b + 0.5) * 2.0 * r + clamp(b - floor(b + 0.5), -r, r);
  return clamp((ib - ia) * period / w, 0.0, 1.0);
}

// grain of a tile, gone to its mean where the footprint passes its texels: the next coarser layer takes over
float grain(vec2 p, float tile, float size) {
  float texels = size / tile * 256.0;
  return (textureLod(noise_map, p / tile, 0.0).r - 0.5) * clamp(1.4 - 0.4 * texels, 0.0, 1.0);
}

vec3 grass_colour(float fine, float middle, float wide) {
  return mix(vec3(0.085, 0.110, 0.045), vec3(0.135, 0.145, 0.065), clamp(0.5 + 1.8 * wide + 1.0 * middle, 0.0, 1.0)) *
         (1.0 + 1.5 * fine + 0.5 * middle);
}

vec3 pavement_colour(vec2 p, vec2 w, float y, float fine, float middle, float wide) {
  return vec3(0.215, 0.21, 0.2) * (1.0 + 0.45 * fine + 0.15 * middle + 0.25 * wide) *
         (1.0 - 0.4 * max(bars(p.x, 0.6, 0.005, w.x), bars(y, 0.6, 0.005, w.y)));
}

// colour of the ground at p, filtered over the footprint w (x, y)
vec3 ground_colour(vec2 p, vec2 w) {
  float size = 0.7 * max(w.x, w.y);
  float fine = grain(p, 1.07, size);
  float middle = grain(p + vec2(3.7, 1.3), 6.3, size);
  float wide = grain(p.yx + vec2(11.0, 5.0), 41.0, size);
  float y = p.y - ground.z;
#if GRASS
  vec3 c = grass_colour(fine, middle, wide);
#else
#if PAVED
  vec3 c = pavement_colour(p, w, y, fine, middle, wide);
#else
  vec3 asphalt = vec3(0.118, 0.117, 0.118) * (1.0 + 0.95 * fine + 0.55 * middle + 0.40 * wide);
  vec3 c = asphalt;
#if ROAD
  float half_width = ground.y;
  // wheels polish two tracks in each lane
  float lane = 2.0 * half_width / max(ground.w, 1.0);
  float track = abs(abs(fract((y + half_width) / lane) - 0.5) * lane - 0.75);
  c *= 1.0 + 0.07 * (1.0 - smoothstep(0.1, 0.5, track)) - 0.03;
#if !PLAIN
  vec3 white = vec3(0.62, 0.62, 0.60) * (0.93 + 0.55 * fine + 0.18 * middle);
  float worn = clamp(1.02 + 0.7 * middle, 0.0, 1.0);
  float paint = bar(abs(y), half_width - 0.25, 0.06, w.y);
  float broken = bars(p.x, 9.0, 1.5, w.x);
  for (int i = 1; i < int(ground.w); ++i) paint = max(paint, broken * bar(y, -half_width + lane * float(i), 0.06, w.y));
#if ZEBRA
  float inside = bar(y, 0.0, half_width - 0.45, w.y);
  float clear_of_zebra = 1.0 - bar(p.x, road.w, 2.4, w.x);
  paint = max(paint * clear_of_zebra, inside * bar(p.x, road.w, 1.75, w.x) * bars(y, 1.0, 0.25, w.y));
#endif
  c = mix(c, white, paint * worn);
#endif
#if !ROADWAY
  // kerb stone, pavement of slabs, grass
  float off = abs(y) - half_width;
  vec3 kerb = vec3(0.25, 0.245, 0.235) * (1.0 + 0.4 * middle + 0.3 * fine);
  vec3 pavement = pavement_colour(p, w, y, fine, middle, wide);
  vec3 grass = grass_colour(fine, middle, wide);
  c = mix(c, kerb, clamp(off / w.y + 0.5, 0.0, 1.0));
  c = mix(c, pavement, clamp((off - 0.15) / w.y + 0.5, 0.0, 1.0));
  c = mix(c, grass, clamp((off - 2.15 - 0.1 * (middle + fine)) / max(w.y, 0.02) + 0.5, 0.0, 1.0));
#endif
#else
  c = vec3(0.165, 0.165, 0.168) * (1.0 + 0.7 * fine + 0.45 * middle + 0.30 * wide);
#endif
#if GRID
  float line = max(bars(p.x, 1.0, 0.008, w.x), bars(p.y, 1.0, 0.008, w.y));
  c = mix(c, vec3(0.42), 0.55 * line);
#endif
#endif
#endif
  return max(c, vec3(0.005));
}

)";

const char* const kOcclusionFragment = R"(
out vec4 colour;
// how much of the sky casters near p hide (0..1)
float occlusion_at(vec3 p) {
  float open = 1.0;
  for (int i = 0; i < counts.x; ++i) {
    vec4 q = vec4(p, 1.0);
    vec3 u = vec3(dot(round_rows[3 * i], q), dot(round_rows[3 * i + 1], q), dot(round_rows[3 * i + 2], q));
    // the up direction in the sphere's own space; cosine to the centre over squared distance is the form factor
    vec3 up = vec3(round_rows[3 * i].z, round_rows[3 * i + 1].z, round_rows[3 * i + 2].z);
    float d2 = max(dot(u, u), 1.0);
    float cosine = max(dot(-u, normalize(up)) * inversesqrt(d2), 0.0);
    open *= 1.0 - 0.9 * cosine / d2;
  }
  for (int i = 0; i < counts.y; ++i) {
    vec4 q = vec4(p, 1.0);
    vec3 b = vec3(dot(box_rows[3 * i], q), dot(box_rows[3 * i + 1], q), dot(box_rows[3 * i + 2], q));
    vec3 h = box_half[i].xyz;
    float rounding = min(0.45, min(h.x, h.y));
    float side = max(length(max(abs(b.xy) - (h.xy - rounding), 0.0)) - rounding, -0.3);
    float under = max(abs(b.z) - h.z, 0.0);
    open *= 1.0 - 0.86 * min(exp(-(side + 0.12) / 0.28), 1.0) / (1.0 + under * under / 0.25);
  }
  return open;
}

void main() {
  vec2 p = occlusion.xy + occlusion.zw * gl_FragCoord.xy / float(OCCLUSION);
  colour = vec4(occlusion_at(vec3(p, ground.x)));
}
)";

const char* const kSkyFragment = R"(
out vec4 colour;
void main() {
  vec3 d = far_0.xyz - near_0.xyz + gl_FragCoord.x * (far_x.xyz - near_x.xyz) + gl_FragCoord.y * (far_y.xyz - near_y.xyz);
  colour = vec4(to_screen(sky_light(normalize(d))) + dither(), 1.0);
}
)";

const char* const kGroundFragment = R"(
uniform float sure_light;  // of the sun, where the tile leaves no doubt
out vec4 colour;

void main() {
  vec3 near_point = near_0.xyz + gl_FragCoord.x * near_x.xyz + gl_FragCoord.y * near_y.xyz;
  vec3 far_point = far_0.xyz + gl_FragCoord.x * far_x.xyz + gl_FragCoord.y * far_y.xyz;
  vec3 d = normalize(far_point - near_point);
  // where the ray meets the ground, and how far that moves from pixel to pixel; behind or beside the horizon: very far
  vec3 ray = far_point - near_point;
  float per_fall = -1.0 / min(ray.z, -1e-6);
  float s = min((near_point.z - ground.x) * per_fall, 1e5);
  vec2 p = near_point.xy + s * ray.xy;
  vec3 along_x = near_x.xyz + s * (far_x.xyz - near_x.xyz), along_y = near_y.xyz + s * (far_y.xyz - near_y.xyz);
  vec2 w = max(abs(along_x.xy + ray.xy * (along_x.z * per_fall)) + abs(along_y.xy + ray.xy * (along_y.z * per_fall)), vec2(1e-4));
#if !NEAR
  float hits = step(1e-5, -d.z);
#endif
  vec3 c = ground_colour(p, min(w, vec2(1e4)));
  float open = 1.0, lit = 1.0;
#if CASTERS
  vec3 p3 = vec3(p, ground.x);
  open = texture(occlusion_map, (p - occlusion.xy) / occlusion.zw).r;
#if SHADOW > 0
  lit = sunlight(p3, vec3(0, 0, 1), 1.0);
#else
  lit = sure_light;
#endif
#endif
  vec3 light = kSunLight * max(sun.z, 0.0) * lit * mix(open, 1.0, 0.6) + ambient_light(vec3(0, 0, 1), 1.0) * open;
  c *= light;
  float far_m = eye.w > 0.5 ? 0.0 : length(vec3(p, ground.x) - eye.xyz);
  // asphalt shines a little against the light
  float steep = 1.0 - clamp(-d.z, 0.0, 1.0), grazing = steep * steep * steep * steep * steep * (1.0 - eye.w);
  c += 0.05 * grazing * open * haze_colour();
#if NEAR
  colour = vec4(to_screen(mix(c, haze_colour(), haze_at(far_m))), 1.0);
#else
  // at the very horizon ground and sky are one haze; the sun's glow fades in with distance
  float horizon = smoothstep(150.0, 900.0, far_m);
  vec3 above = sky_light(vec3(d.xy, max(d.z, 0.0)));
  c = mix(mix(c, haze_colour(), mix(haze_at(far_m), 1.0, horizon)), above, horizon);
  colour = vec4(to_screen(mix(above, c, hits)) + dither(), 1.0);
#endif
}
)";

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
in vec3 strip;
in vec2 place;
out vec4 colour;
void main() {
  float w = max(fwidth(strip.x), 1e-4);
  float edge = clamp((1.0 - abs(strip.x)) / max(w, 0.22), 0.0, 1.0);
  vec2 foot = fwidth(place);
  float rough = 0.75 + 0.9 * grain(place, 1.07, 0.7 * max(foot.x, foot.y));
  // ribs of the tread run along the mark
  float ribs = mix(0.80 + 0.20 * cos(strip.x * 12.0), 0.8, smoothstep(0.15, 0.5, w));
  float dark = clamp(strip.y * edge * rough * ribs, 0.0, 1.0) * 0.8;
  colour = vec4(to_screen(vec3(0.012)), dark);
}
)";

}  // namespace render::gl
