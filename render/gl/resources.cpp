#include "render/gl/resources.h"

#include <utility>

#include "render/error.h"
#include "render/gl/gl.h"

namespace render::gl {
namespace {

unsigned compile(unsigned kind, const std::string& source) {
  const unsigned shader = glCreateShader(kind);
  const char* text = source.c_str();
  glShaderSource(shader, 1, &text, nullptr);
  glCompileShader(shader);
  int ok = 0;
  glGetShaderiv(shader, GL_COMPILE_STATUS, &ok);
  if (!ok) {
    char log[2048] = "";
    glGetShaderInfoLog(shader, sizeof log, nullptr, log);
    throw RenderError(std::string("a shader does not compile: ") + log);
  }
  return shader;
}

}  // namespace

Program::Program(const std::string& vertex, const std::string& fragment) : id_(glCreateProgram()) {
  const unsigned v = compile(GL_VERTEX_SHADER, vertex), f = compile(GL_FRAGMENT_SHADER, fragment);
  glAttachShader(id_, v);
  glAttachShader(id_, f);
  glLinkProgram(id_);
  glDeleteShader(v);
  glDeleteShader(f);
  int ok = 0;
  glGetProgramiv(id_, GL_LINK_STATUS, &ok);
  if (!ok) {
    char log[2048] = "";
    glGetProgramInfoLog(id_, sizeof log, nullptr, log);
    throw RenderError(std::string("a shader does not link: ") + log);
  }
}

Program::~Program() {
  glDeleteProgram(id_);
}
void Program::use() const {
  glUseProgram(id_);
}
int Program::location(const char* name) const {
  return glGetUniformLocation(id_, name);
}
void Program::set(const char* name, int value) const {
  glUniform1i(location(name), value);
}
void Program::set(const char* name, float value) const {
  glUniform1f(location(name), value);
}
void Program::set(const char* name, const Float3& v) const {
  glUniform3f(location(name), v[0], v[1], v[2]);
}
void Program::set(const char* name, float x, float y) const {
  glUniform2f(location(name), x, y);
}
void Program::set(const char* name, const Matrix4& value) const {
  glUniformMatrix4fv(location(name), 1, GL_FALSE, value.data());
}

VertexBuffer::VertexBuffer() {
  glGenVertexArrays(1, &array_);
  glGenBuffers(3, buffers_);
}

VertexBuffer::VertexBuffer(VertexBuffer&& other) noexcept {
  std::swap(array_, other.array_);
  std::swap(buffers_, other.buffers_);
  std::swap(count_, other.count_);
}

VertexBuffer::~VertexBuffer() {
  if (array_) {
    glDeleteBuffers(3, buffers_);
    glDeleteVertexArrays(1, &array_);
  }
}

void VertexBuffer::upload(const std::vector<float>& positions, const std::vector<float>& normals,
                          const std::vector<std::uint32_t>& indices) {
  glBindVertexArray(array_);
  const std::vector<float>* data[2] = {&positions, &normals};
  for (unsigned i = 0; i < 2; ++i) {
    glBindBuffer(GL_ARRAY_BUFFER, buffers_[i]);
    glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(data[i]->size() * sizeof(float)), data[i]->data(), GL_DYNAMIC_DRAW);
    glVertexAttribPointer(i, 3, GL_FLOAT, GL_FALSE, 0, nullptr);
    glEnableVertexAttribArray(i);
  }
  glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, buffers_[2]);
  glBufferData(GL_ELEMENT_ARRAY_BUFFER, static_cast<GLsizeiptr>(indices.size() * sizeof(std::uint32_t)), indices.data(),
               GL_DYNAMIC_DRAW);
  count_ = static_cast<std::uint32_t>(indices.size());
}

void VertexBuffer::draw(std::uint32_t first, std::uint32_t count) const {
  glBindVertexArray(array_);
  glDrawElements(GL_TRIANGLES, static_cast<GLsizei>(count), GL_UNSIGNED_INT,
                 reinterpret_cast<const void*>(static_cast<std::uintptr_t>(first) * sizeof(std::uint32_t)));
}

Target::Target(int width, int height, int samples) : width_(width), height_(height) {
  glGenFramebuffers(1, &frame_);
  glGenRenderbuffers(1, &colour_);
  glGenRenderbuffers(1, &depth_);
  glBindFramebuffer(GL_FRAMEBUFFER, frame_);
  glBindRenderbuffer(GL_RENDERBUFFER, colour_);
  glRenderbufferStorageMultisample(GL_RENDERBUFFER, samples > 1 ? samples : 0, GL_RGBA8, width, height);
  glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, colour_);
  glBindRenderbuffer(GL_RENDERBUFFER, depth_);
  glRenderbufferStorageMultisample(GL_RENDERBUFFER, samples > 1 ? samples : 0, GL_DEPTH_COMPONENT24, width, height);
  glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER, depth_);
  if (glCheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE)
    throw RenderError("cannot make a framebuffer of " + std::to_string(width) + "x" + std::to_string(height));
}

Target::~Target() {
  glDeleteFramebuffers(1, &frame_);
  glDeleteRenderbuffers(1, &colour_);
  glDeleteRenderbuffers(1, &depth_);
}

void Target::bind() const {
  glBindFramebuffer(GL_FRAMEBUFFER, frame_);
  glViewport(0, 0, width_, height_);
}

void Target::resolve_into(const Target& to) const {
  glBindFramebuffer(GL_READ_FRAMEBUFFER, frame_);
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, to.frame_);
  glBlitFramebuffer(0, 0, width_, height_, 0, 0, to.width_, to.height_, GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT, GL_NEAREST);
}

ShadowMap::ShadowMap(int size) : size_(size) {
  glGenTextures(1, &texture_);
  glBindTexture(GL_TEXTURE_2D, texture_);
  glTexImage2D(GL_TEXTURE_2D, 0, GL_DEPTH_COMPONENT24, size, size, 0, GL_DEPTH_COMPONENT, GL_UNSIGNED_INT, nullptr);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_COMPARE_MODE, GL_COMPARE_REF_TO_TEXTURE);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_COMPARE_FUNC, GL_LEQUAL);
  glGenFramebuffers(1, &frame_);
  glBindFramebuffer(GL_FRAMEBUFFER, frame_);
  glFramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_TEXTURE_2D, texture_, 0);
  glDrawBuffer(GL_NONE);
  glReadBuffer(GL_NONE);
  if (glCheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE) throw RenderError("cannot make the shadow map");
}

ShadowMap::~ShadowMap() {
  glDeleteFramebuffers(1, &frame_);
  glDeleteTextures(1, &texture_);
}

void ShadowMap::bind_for_drawing() const {
  glBindFramebuffer(GL_FRAMEBUFFER, frame_);
  glViewport(0, 0, size_, size_);
}

void ShadowMap::bind_texture() const {
  glActiveTexture(GL_TEXTURE0);
  glBindTexture(GL_TEXTURE_2D, texture_);
}

}  // namespace render::gl
