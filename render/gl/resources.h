// RAII for the few GL objects the passes use. All need a current context.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "render/draw_list.h"

namespace render::gl {

/// A linked program; uniforms are set by name.
class Program {
 public:
  Program(const std::string& vertex, const std::string& fragment);  // throws RenderError with the compiler's words
  ~Program();
  Program(const Program&) = delete;
  Program& operator=(const Program&) = delete;
  void use() const;
  void set(const char* name, int value) const;
  void set(const char* name, float value) const;
  void set(const char* name, const Float3& value) const;
  void set(const char* name, float x, float y) const;
  void set(const char* name, const Matrix4& value) const;
  int location(const char* name) const;

 private:
  unsigned id_ = 0;
};

/// Vertex arrays of positions and normals with indices.
class VertexBuffer {
 public:
  VertexBuffer();
  ~VertexBuffer();
  VertexBuffer(VertexBuffer&&) noexcept;
  VertexBuffer(const VertexBuffer&) = delete;
  VertexBuffer& operator=(const VertexBuffer&) = delete;
  void upload(const std::vector<float>& positions, const std::vector<float>& normals, const std::vector<std::uint32_t>& indices);
  void draw(std::uint32_t first, std::uint32_t count) const;
  std::uint32_t size() const { return count_; }

 private:
  unsigned array_ = 0, buffers_[3] = {0, 0, 0};
  std::uint32_t count_ = 0;
};

/// Colour and depth to draw into; `samples` > 1 multisampled.
class Target {
 public:
  Target(int width, int height, int samples);
  ~Target();
  Target(const Target&) = delete;
  Target& operator=(const Target&) = delete;
  void bind() const;
  void resolve_into(const Target&) const;
  int width() const { return width_; }
  int height() const { return height_; }

 private:
  unsigned frame_ = 0, colour_ = 0, depth_ = 0;
  int width_ = 0, height_ = 0;
};

/// Depth seen from the sun, for comparison sampling.
class ShadowMap {
 public:
  explicit ShadowMap(int size);
  ~ShadowMap();
  ShadowMap(const ShadowMap&) = delete;
  ShadowMap& operator=(const ShadowMap&) = delete;
  void bind_for_drawing() const;
  void bind_texture() const;
  int size() const { return size_; }

 private:
  unsigned frame_ = 0, texture_ = 0;
  int size_ = 0;
};

}  // namespace render::gl
