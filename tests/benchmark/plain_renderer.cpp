#include "plain_renderer.h"

#include <algorithm>
#include <cstddef>
#include <string>

#include "render/matrix.h"
#include "render/text/labels.h"

namespace render {
namespace {

using namespace render::gl;

constexpr int kSamples = 4, kShadowSize = 2048;

// the beginning of shade::FrameData, std140
const char* const kFrameBlock = R"(
layout(std140) uniform Frame {
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

const char* const kLight = R"(
uniform sampler2DShadow shadow_map;
uniform mat4 world_to_shadow;
float lit(vec3 p) {
  vec3 at = (world_to_shadow * vec4(p, 1.0)).xyz;
  float sum = 0.0;
  for (int y = -1; y <= 1; ++y)
    for (int x = -1; x <= 1; ++x) sum += texture(shadow_map, vec3(at.xy + vec2(x, y) / 2048.0, at.z));
  return sum / 9.0;
}
vec3 sky(vec3 d) { return mix(vec3(0.78, 0.84, 0.90), vec3(0.24, 0.41, 0.68), 1.0 - exp(-5.0 * max(d.z, 0.0))); }
vec3 shown(vec3 c) { return pow(c / (c + 0.6) * 1.2, vec3(1.0 / 2.2)); }
)";

const char* const kScreenVertex = R"(
void main() { gl_Position = vec4(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0, 0.9999, 1.0); }
)";

const char* const kGround = R"(
out vec4 colour;
float grain(vec2 p) { return fract(sin(dot(floor(p), vec2(12.9898, 78.233))) * 43758.5453); }
void main() {
  vec3 from = near_0.xyz + gl_FragCoord.x * near_x.xyz + gl_FragCoord.y * near_y.xyz;
  vec3 d = normalize(far_0.xyz + gl_FragCoord.x * far_x.xyz + gl_FragCoord.y * far_y.xyz - from);
  vec3 c = sky(d);
  if (d.z < 0.0) {
    vec3 p = from + d * ((ground.x - from.z) / d.z);
    float across = abs(p.y - ground.z);
    vec3 base = across < ground.y ? vec3(0.12) : vec3(0.11, 0.13, 0.05);
    if (abs(across - ground.y + 0.25) < 0.06) base = vec3(0.6);
    base *= 0.8 + 0.4 * (grain(p.xy * 200.0) + grain(p.xy * 40.0) + grain(p.xy * 6.0)) / 3.0;
    vec3 c_ground = base * (vec3(1.95, 1.83, 1.63) * sun.z * lit(p) + vec3(0.36, 0.43, 0.53));
    c = mix(c_ground, c, 1.0 - exp(-0.004 * length(p - eye.xyz)));
  }
  colour = vec4(shown(c), 1.0);
}
)";

const char* const kShadowVertex = R"(
layout(location = 0) in vec3 position;
uniform mat4 model_to_clip;
void main() { gl_Position = model_to_clip * vec4(position, 1.0); }
)";
const char* const kShadowFragment = R"(
out vec4 colour;
void main() { colour = vec4(0.0); }
)";

const char* const kThingVertex = R"(
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
uniform mat4 model;
uniform mat4 world_to_clip;
out vec3 at_W;
out vec3 normal_W;
void main() {
  vec4 p = model * vec4(position, 1.0);
  at_W = p.xyz;
  normal_W = mat3(model) * normal;
  gl_Position = world_to_clip * p;
}
)";
const char* const kThing = R"(
in vec3 at_W;
in vec3 normal_W;
uniform vec3 base;
uniform float reflects;
out vec4 colour;
void main() {
  vec3 v = normalize(eye.xyz - at_W), n = normalize(normal_W);
  n = dot(n, v) < 0.0 ? -n : n;
  float s = lit(at_W + 0.02 * n), fresnel = pow(1.0 - max(dot(n, v), 0.0), 5.0);
  vec3 c = base * (vec3(1.95, 1.83, 1.63) * max(dot(n, sun.xyz), 0.0) * s + mix(vec3(0.19), vec3(0.40), 0.5 + 0.5 * n.z));
  c += (reflects + 0.8 * fresnel * reflects) * sky(reflect(-v, n));
  c += s * 0.3 * pow(max(dot(n, normalize(sun.xyz + v)), 0.0), 60.0);
  colour = vec4(shown(c), 1.0);
}
)";

void store(const Renderbuffer& r, GLenum attachment, GLenum format, int samples, int width, int height) {
  glBindRenderbuffer(GL_RENDERBUFFER, *r);
  glRenderbufferStorageMultisample(GL_RENDERBUFFER, samples, format, width, height);
  glFramebufferRenderbuffer(GL_FRAMEBUFFER, attachment, GL_RENDERBUFFER, *r);
}

std::unique_ptr<Program> program(const std::string& vertex, const std::string& fragment) {
  return std::make_unique<Program>("", kFrameBlock + vertex, kFrameBlock + fragment);
}

}  // namespace

PlainRenderer::PlainRenderer(int width, int height) : width_(width), height_(height), context_(GlContext::Threads::own) {
  glBindFramebuffer(GL_FRAMEBUFFER, *many_);
  store(many_colour_, GL_COLOR_ATTACHMENT0, GL_RGBA8, kSamples, width, height);
  store(many_depth_, GL_DEPTH_ATTACHMENT, GL_DEPTH_COMPONENT24, kSamples, width, height);
  glBindFramebuffer(GL_FRAMEBUFFER, *one_);
  store(one_colour_, GL_COLOR_ATTACHMENT0, GL_RGBA8, 0, width, height);
  store(one_depth_, GL_DEPTH_ATTACHMENT, GL_DEPTH_COMPONENT24, 0, width, height);
  glBindTexture(GL_TEXTURE_2D, *shadow_depth_);
  glTexImage2D(GL_TEXTURE_2D, 0, GL_DEPTH_COMPONENT24, kShadowSize, kShadowSize, 0, GL_DEPTH_COMPONENT, GL_UNSIGNED_INT, nullptr);
  for (const GLenum filter : {GL_TEXTURE_MIN_FILTER, GL_TEXTURE_MAG_FILTER}) glTexParameteri(GL_TEXTURE_2D, filter, GL_LINEAR);
  for (const GLenum wrap : {GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T}) glTexParameteri(GL_TEXTURE_2D, wrap, GL_CLAMP_TO_EDGE);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_COMPARE_MODE, GL_COMPARE_REF_TO_TEXTURE);
  glBindFramebuffer(GL_FRAMEBUFFER, *shadow_);
  glFramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_TEXTURE_2D, *shadow_depth_, 0);
  glDrawBuffer(GL_NONE);
  depth_ = program(kShadowVertex, kShadowFragment);
  ground_ = program(kScreenVertex, std::string(kLight) + kGround);
  thing_ = program(kThingVertex, std::string(kLight) + kThing);
}

void PlainRenderer::draw_run(const Piece& piece, const Geometry::Level& level) {
  const Geometry& g = *piece.geometry;
  std::unique_ptr<Uploaded>& on_gl = uploaded_[&g];
  const bool first = !on_gl;
  if (first) on_gl = std::make_unique<Uploaded>();
  glBindVertexArray(*on_gl->array);
  if (first || (g.moves && piece.run == 0)) {
    std::vector<float> data;
    for (std::size_t v = 0; v < static_cast<std::size_t>(g.count); ++v)
      for (const std::vector<float>& list : g.vertices) data.push_back(list[v]);
    glBindBuffer(GL_ARRAY_BUFFER, *on_gl->vertices);
    glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(data.size() * sizeof(float)), data.data(), GL_STATIC_DRAW);
    for (GLuint i = 0; i < 2; ++i) {
      glEnableVertexAttribArray(i);
      glVertexAttribPointer(i, 3, GL_FLOAT, GL_FALSE, 6 * sizeof(float),
                            reinterpret_cast<const void*>(std::size_t{i} * 3 * sizeof(float)));
    }
  }
  if (first) {
    glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, *on_gl->indices);
    glBufferData(GL_ELEMENT_ARRAY_BUFFER, static_cast<GLsizeiptr>(g.indices.size() * sizeof(std::uint32_t)), g.indices.data(),
                 GL_STATIC_DRAW);
  }
  glDrawElements(GL_TRIANGLES, static_cast<GLsizei>(level.runs[piece.run].count), GL_UNSIGNED_INT,
                 reinterpret_cast<const void*>(std::size_t{level.runs[piece.run].first} * sizeof(std::uint32_t)));
}

void PlainRenderer::draw_shadows(const std::vector<Piece>& pieces, const FrameSetup& frame) {
  glBindFramebuffer(GL_FRAMEBUFFER, *shadow_);
  glViewport(0, 0, kShadowSize, kShadowSize);
  glClear(GL_DEPTH_BUFFER_BIT);
  glEnable(GL_POLYGON_OFFSET_FILL);
  glPolygonOffset(1.5f, 4.0f);
  depth_->use();
  for (const Piece& piece : pieces) {
    depth_->set("model_to_clip", to_gl(frame.world_to_shadow_clip * from_gl(piece.model)));
    draw_run(piece, piece.geometry->levels.front());
  }
  glDisable(GL_POLYGON_OFFSET_FILL);
}

void PlainRenderer::draw_scene(const std::vector<Piece>& pieces, const FrameSetup& frame) {
  glBindFramebuffer(GL_FRAMEBUFFER, *many_);
  glViewport(0, 0, width_, height_);
  glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
  glActiveTexture(GL_TEXTURE0);
  glBindTexture(GL_TEXTURE_2D, *shadow_depth_);
  Matrix4 world_to_shadow;
  std::copy_n(frame.data.world_to_shadow, 16, world_to_shadow.begin());
  ground_->use();
  ground_->set("world_to_shadow", world_to_shadow);
  glBindVertexArray(*nothing_);
  glDrawArrays(GL_TRIANGLES, 0, 3);
  thing_->use();
  thing_->set("world_to_shadow", world_to_shadow);
  thing_->set("world_to_clip", to_gl(frame.world_to_clip));
  for (const Piece& piece : pieces) {
    const float* row = materials_.rows() + 16 * piece.row;
    thing_->set("model", piece.model);
    thing_->set("base", Float3{row[0], row[1], row[2]});
    thing_->set("reflects", row[4]);
    draw_run(piece, *piece.level);
  }
}

void PlainRenderer::draw(const DrawList& list, Image& out) {
  std::vector<CasterBox> boxes;
  const std::vector<Piece> pieces = collect(list, geometry_, materials_, 0.2, height_, boxes);
  const FrameSetup frame = set_up_frame(list, boxes, width_, height_, kShadowSize);
  glBindBuffer(GL_UNIFORM_BUFFER, *block_);
  glBufferData(GL_UNIFORM_BUFFER, offsetof(shade::FrameData, world_to_shadow), &frame.data, GL_STREAM_DRAW);
  glBindBufferBase(GL_UNIFORM_BUFFER, 0, *block_);
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_LEQUAL);
  glDepthMask(GL_TRUE);
  glDisable(GL_BLEND);
  draw_shadows(pieces, frame);
  draw_scene(pieces, frame);
  glBindFramebuffer(GL_READ_FRAMEBUFFER, *many_);
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, *one_);
  glBlitFramebuffer(0, 0, width_, height_, 0, 0, width_, height_, GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT, GL_NEAREST);
  glBindFramebuffer(GL_FRAMEBUFFER, *one_);
  out.width = width_;
  out.height = height_;
  const std::size_t row = 4 * static_cast<std::size_t>(width_);
  out.rgba.resize(row * static_cast<std::size_t>(height_));
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glReadPixels(0, 0, width_, height_, GL_RGBA, GL_UNSIGNED_BYTE, out.rgba.data());
  overlays_.begin(list, width_, height_);
  overlays_.draw_behind({0, 0, width_, height_});
  overlays_.finish({out.rgba.data(), width_, height_, width_});
  for (int y = 0; y < height_ / 2; ++y) {
    std::uint8_t* a = out.rgba.data() + row * static_cast<std::size_t>(y);
    std::swap_ranges(a, a + row, out.rgba.data() + row * static_cast<std::size_t>(height_ - 1 - y));
  }
  draw_labels(list, out);
}

}  // namespace render
