// The passes of a frame: shadow map, background, skid marks, objects, glass, resolve, overlays, read-back, labels.
#include "render/renderer.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstring>
#include <map>
#include <tuple>

#include "render/gl/context.h"
#include "render/gl/gl.h"
#include "render/gl/overlay_pass.h"
#include "render/gl/resources.h"
#include "render/gl/shaders.h"
#include "render/matrix.h"
#include "render/surface/tessellate.h"
#include "render/text/labels.h"

namespace render {
namespace {

using gl::Program;
using gl::ShadowMap;
using gl::Target;
using gl::VertexBuffer;

struct Settings {
  int samples, supersample, shadow_size, shadow_taps;
  float shadow_blur;
  double tolerance;  // [m] of tessellation
};

Settings settings_of(Quality quality) {
  switch (quality) {
    case Quality::draft:
      return {1, 1, 1024, 4, 1.2f, 2e-3};
    case Quality::fine:
      return {4, 2, 4096, 16, 3.5f, 3e-4};
    default:
      return {4, 1, 2048, 12, 1.8f, 8e-4};
  }
}

struct MeshBounds {
  Vec3 centre = Vec3::Zero(), half = Vec3::Zero();
};

MeshBounds bounds_of(const Mesh& mesh) {
  Vec3 low = Vec3::Constant(1e30), high = Vec3::Constant(-1e30);
  for (std::size_t i = 0; i + 2 < mesh.positions.size(); i += 3) {
    const Vec3 p(mesh.positions[i], mesh.positions[i + 1], mesh.positions[i + 2]);
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  return {0.5 * (low + high), 0.5 * (high - low)};
}

/// Mean of each supersample x supersample block.
void shrink(const std::vector<std::uint8_t>& from, int width, int height, int factor, Image& out) {
  out.width = width / factor;
  out.height = height / factor;
  out.rgba.resize(static_cast<std::size_t>(4 * out.width * out.height));
  for (int y = 0; y < out.height; ++y)
    for (int x = 0; x < out.width; ++x)
      for (int c = 0; c < 4; ++c) {
        int sum = 0;
        for (int j = 0; j < factor; ++j)
          for (int i = 0; i < factor; ++i)
            sum += from[static_cast<std::size_t>(4 * ((height - 1 - (y * factor + j)) * width + x * factor + i) + c)];
        out.rgba[static_cast<std::size_t>(4 * (y * out.width + x) + c)] =
            static_cast<std::uint8_t>((sum + factor * factor / 2) / (factor * factor));
      }
}

}  // namespace

struct Renderer::Impl {
  Impl(int w, int h, Quality quality)
      : settings(settings_of(quality)),
        width(w * settings.supersample),
        height(h * settings.supersample),
        context(width, height),
        objects(std::string(shaders::kObjectVertex), std::string(shaders::kCommon) + shaders::kObjectFragment),
        background(shaders::kBackgroundVertex, std::string(shaders::kCommon) + shaders::kBackgroundFragment),
        shadow(shaders::kShadowVertex, shaders::kShadowFragment),
        shadow_map(settings.shadow_size),
        multisampled(width, height, settings.samples),
        resolved(width, height, 1) {
    glGenVertexArrays(1, &empty_array);
  }

  const VertexBuffer& ellipsoid(const EllipsoidItem& item) {
    const auto& a = item.shape.semi_axes;
    const auto key = std::make_tuple(a.x(), a.y(), a.z(), item.shape.exponent);
    auto at = ellipsoids.find(key);
    if (at == ellipsoids.end()) {
      const Tessellation t = tessellate(item.shape, cells_for(item.shape, settings.tolerance));
      VertexBuffer buffer;
      buffer.upload(t.positions, t.normals, t.indices);
      at = ellipsoids.emplace(key, std::move(buffer)).first;
    }
    return at->second;
  }

  struct CachedMesh {
    std::shared_ptr<const Mesh> keep;  // its address is the key: it must not be reused
    VertexBuffer buffer;
    MeshBounds bounds;
  };
  const CachedMesh& mesh(const std::shared_ptr<const Mesh>& m) {
    auto at = meshes.find(m.get());
    if (at == meshes.end()) {
      VertexBuffer buffer;
      buffer.upload(m->positions, m->normals, m->indices);
      at = meshes.emplace(m.get(), CachedMesh{m, std::move(buffer), bounds_of(*m)}).first;
    }
    return at->second;
  }

  void upload_skins(const DrawList& list) {
    while (skins.size() < list.skins.size()) skins.emplace_back();
    for (std::size_t i = 0; i < list.skins.size(); ++i)
      skins[i].upload(list.skins[i].positions, list.skins[i].normals, list.skins[i].topology->indices);
  }

  Mat4 fit_shadow(const DrawList& list, const Vec3& sun);
  void draw_shadow(const DrawList& list, const Matrix4& world_to_shadow);
  void set_light(const Program&, const DrawList&, const Vec3& sun, const Matrix4& world_to_shadow);
  void draw_background(const DrawList&, const Vec3& sun, const Matrix4& world_to_shadow);
  void set_occluders(const DrawList&);
  void draw_objects(const DrawList&, const Vec3& sun, const Matrix4& world_to_shadow);
  void set_material(const Material&);

  Settings settings;
  int width, height;
  GlContext context;
  Program objects, background, shadow;
  ShadowMap shadow_map;
  Target multisampled, resolved;
  gl::OverlayPass overlays;
  unsigned empty_array = 0;
  std::map<std::tuple<double, double, double, double>, VertexBuffer> ellipsoids;
  std::map<const Mesh*, CachedMesh> meshes;
  std::vector<VertexBuffer> skins;
  std::vector<std::uint8_t> pixels;
  std::string timings;
};

Mat4 Renderer::Impl::fit_shadow(const DrawList& list, const Vec3& sun) {
  Mat4 view = look_at(sun, Vec3::Zero(), std::abs(sun.z()) > 0.95 ? Vec3(Vec3::UnitX()) : Vec3(Vec3::UnitZ()));
  // the sun has a direction and no place: a shift along it would push the casters nearest to it out of the map
  view.topRightCorner<3, 1>().setZero();
  Vec3 low = Vec3::Constant(1e30), high = Vec3::Constant(-1e30);
  const Vec3 eye(list.view.eye[0], list.view.eye[1], list.view.eye[2]);
  auto add = [&](const Matrix4& model, double radius) {
    const Vec3 p(model[12], model[13], model[14]);
    if ((p - eye).norm() > 80) return;
    // the shadow on the ground belongs to the box too
    const double above = std::max(0.0, p.z() - list.road.height);
    for (const Vec3& q : {p, Vec3(p - sun * (above / std::max(sun.z(), 0.15)))}) {
      const Vec3 s = view.topLeftCorner<3, 3>() * q;
      low = low.cwiseMin(s - Vec3::Constant(radius));
      high = high.cwiseMax(s + Vec3::Constant(radius));
    }
  };
  for (const EllipsoidItem& e : list.ellipsoids) add(e.model, e.shape.semi_axes.norm());
  for (const MeshItem& m : list.meshes) {
    // the mesh's origin need not be its middle
    const MeshBounds& b = mesh(m.mesh).bounds;
    add(m.model, b.centre.norm() + b.half.norm());
  }
  for (const SkinItem& s : list.skins) {
    Matrix4 at{};
    for (std::size_t i = 0; i < 3 && i < s.positions.size(); ++i) at[12 + i] = s.positions[i];
    add(at, 2.2);
  }
  if (low.x() > high.x()) low = Vec3::Constant(-1), high = Vec3::Constant(1);
  Mat4 m = Mat4::Identity();
  for (int i = 0; i < 3; ++i) {
    const double half = 0.5 * (high[i] - low[i]) + 0.05, centre = 0.5 * (high[i] + low[i]);
    const double sign = i == 2 ? -1 : 1;
    m(i, i) = sign / half;
    m(i, 3) = -sign * centre / half;
  }
  return m * view;
}

void Renderer::Impl::draw_shadow(const DrawList& list, const Matrix4& world_to_shadow) {
  shadow_map.bind_for_drawing();
  glClear(GL_DEPTH_BUFFER_BIT);
  glEnable(GL_DEPTH_TEST);
  glDepthMask(GL_TRUE);
  shadow.use();
  shadow.set("world_to_shadow", world_to_shadow);
  for (const EllipsoidItem& e : list.ellipsoids) {
    if (e.raster) continue;
    shadow.set("model", e.model);
    const VertexBuffer& buffer = ellipsoid(e);
    buffer.draw(0, buffer.size());
  }
  for (const MeshItem& m : list.meshes) {
    shadow.set("model", m.model);
    const VertexBuffer& buffer = mesh(m.mesh).buffer;
    buffer.draw(0, buffer.size());
  }
  shadow.set("model", to_gl(Mat4::Identity()));
  for (std::size_t i = 0; i < list.skins.size(); ++i) skins[i].draw(0, skins[i].size());
}

void Renderer::Impl::set_light(const Program& program, const DrawList& list, const Vec3& sun, const Matrix4& world_to_shadow) {
  program.use();
  program.set("sun", to_float(sun));
  program.set("haze", static_cast<float>(list.sky.haze));
  program.set("eye", list.view.eye);
  program.set("world_to_shadow", world_to_shadow);
  program.set("shadow_map", 0);
  program.set("shadow_texel", 1.0f / static_cast<float>(shadow_map.size()));
  program.set("shadow_taps", settings.shadow_taps);
  program.set("shadow_blur", settings.shadow_blur);
  program.set("ground_height", static_cast<float>(list.road.height));
  Float3 direction{0, 0, 0};
  if (list.view.orthographic) {
    const Matrix4& v = list.view.world_to_eye;
    direction = {-v[2], -v[6], -v[10]};
  }
  program.set("view_direction", direction);
}

void Renderer::Impl::set_occluders(const DrawList& list) {
  // the lowest ellipsoids darken the ground beneath them
  std::vector<std::array<float, 4>> spheres;
  for (const EllipsoidItem& e : list.ellipsoids) {
    const double r = std::cbrt(e.shape.semi_axes.prod());
    if (e.model[14] - list.road.height > 1.2) continue;
    spheres.push_back({e.model[12], e.model[13], e.model[14], static_cast<float>(r)});
  }
  std::stable_sort(spheres.begin(), spheres.end(), [](auto& a, auto& b) { return a[2] < b[2]; });
  if (spheres.size() > 32) spheres.resize(32);
  background.set("occluders", static_cast<int>(spheres.size()));
  if (!spheres.empty()) glUniform4fv(background.location("occluder"), static_cast<int>(spheres.size()), spheres[0].data());
  int boxes = 0;
  for (const MeshItem& m : list.meshes) {
    const MeshBounds& b = mesh(m.mesh).bounds;
    if (b.half.norm() < 1 || boxes == 4) continue;
    Mat4 to_box = from_gl(m.model).inverse();
    to_box.topRightCorner<3, 1>() -= b.centre;
    const std::string index = "[" + std::to_string(boxes) + "]";
    background.set(("box_from_world" + index).c_str(), to_gl(to_box));
    background.set(("box_half" + index).c_str(), to_float(b.half));
    ++boxes;
  }
  background.set("boxes", boxes);
}

void Renderer::Impl::draw_background(const DrawList& list, const Vec3& sun, const Matrix4& world_to_shadow) {
  set_light(background, list, sun, world_to_shadow);
  const Mat4 to_clip = from_gl(list.view.eye_to_clip) * from_gl(list.view.world_to_eye);
  background.set("clip_to_world", to_gl(to_clip.inverse()));
  background.set("pixel_size", 2.0f / static_cast<float>(width), 2.0f / static_cast<float>(height));
  background.set("road", list.road.road ? 1 : 0);
  background.set("road_width", static_cast<float>(list.road.width));
  background.set("road_centre", static_cast<float>(list.road.centre_y));
  background.set("lanes", list.road.lanes);
  background.set("metre_grid", list.road.metre_grid ? 1 : 0);
  background.set("zebra", list.road.zebra ? 1 : 0);
  background.set("zebra_x", static_cast<float>(list.road.zebra_x));
  set_occluders(list);
  glDisable(GL_DEPTH_TEST);
  glDepthMask(GL_FALSE);
  glBindVertexArray(empty_array);
  glDrawArrays(GL_TRIANGLES, 0, 3);
}

void Renderer::Impl::set_material(const Material& material) {
  objects.set("kind", static_cast<int>(material.kind));
  objects.set("colour", Float3{material.colour[0], material.colour[1], material.colour[2]});
  objects.set("roughness", material.roughness);
  objects.set("opacity", material.opacity);
}

void Renderer::Impl::draw_objects(const DrawList& list, const Vec3& sun, const Matrix4& world_to_shadow) {
  set_light(objects, list, sun, world_to_shadow);
  objects.set("view", list.view.world_to_eye);
  objects.set("projection", list.view.eye_to_clip);
  glEnable(GL_DEPTH_TEST);
  glDepthMask(GL_TRUE);
  for (const EllipsoidItem& e : list.ellipsoids) {
    objects.set("model", e.model);
    objects.set("raster", e.raster ? 1 : 0);
    objects.set("axes", to_float(e.shape.semi_axes));
    set_material(e.material);
    const VertexBuffer& buffer = ellipsoid(e);
    buffer.draw(0, buffer.size());
  }
  objects.set("raster", 0);
  for (const bool glass : {false, true}) {
    if (glass) {
      glEnable(GL_BLEND);
      glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
    }
    for (const MeshItem& m : list.meshes) {
      objects.set("model", m.model);
      const VertexBuffer& buffer = mesh(m.mesh).buffer;
      for (const Mesh::Part& part : m.mesh->parts) {
        const Material& material = m.materials[static_cast<std::size_t>(part.material)];
        if ((material.opacity < 1) != glass) continue;
        set_material(material);
        buffer.draw(part.first, part.count);
      }
    }
    if (!glass) {
      objects.set("model", to_gl(Mat4::Identity()));
      for (std::size_t i = 0; i < list.skins.size(); ++i)
        for (const Mesh::Part& part : list.skins[i].topology->parts) {
          set_material(list.skins[i].topology->materials[static_cast<std::size_t>(part.material)]);
          skins[i].draw(part.first, part.count);
        }
    }
  }
  glDisable(GL_BLEND);
}

Renderer::Renderer(int width, int height, Quality quality) : impl_(std::make_unique<Impl>(width, height, quality)) {}
Renderer::~Renderer() = default;
std::string Renderer::timings() const {
  return impl_->timings;
}

void Renderer::draw(const DrawList& list, Image& out) {
  using Clock = std::chrono::steady_clock;
  Impl& r = *impl_;
  const auto start = Clock::now();
  const Vec3 sun(std::cos(list.sky.sun_elevation) * std::cos(list.sky.sun_azimuth),
                 std::cos(list.sky.sun_elevation) * std::sin(list.sky.sun_azimuth), std::sin(list.sky.sun_elevation));
  const Matrix4 world_to_shadow = to_gl(r.fit_shadow(list, sun));
  r.upload_skins(list);
  r.draw_shadow(list, world_to_shadow);
  const auto shadowed = Clock::now();
  r.multisampled.bind();
  glClear(GL_DEPTH_BUFFER_BIT);
  r.shadow_map.bind_texture();
  r.draw_background(list, sun, world_to_shadow);
  if (!list.strips.empty()) r.overlays.draw_strips(list, r.width, r.height);
  r.draw_objects(list, sun, world_to_shadow);
  r.multisampled.resolve_into(r.resolved);
  r.resolved.bind();
  r.overlays.draw(list, r.width, r.height);
  r.pixels.resize(static_cast<std::size_t>(4 * r.width * r.height));
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glReadPixels(0, 0, r.width, r.height, GL_RGBA, GL_UNSIGNED_BYTE, r.pixels.data());
  const auto drawn = Clock::now();
  shrink(r.pixels, r.width, r.height, r.settings.supersample, out);
  for (std::size_t i = 3; i < out.rgba.size(); i += 4) out.rgba[i] = 255;
  draw_labels(list, out);
  const auto done = Clock::now();
  auto ms = [](auto from, auto to) { return std::to_string(std::chrono::duration<double, std::milli>(to - from).count()); };
  r.timings = "shadow " + ms(start, shadowed) + " ms, picture " + ms(shadowed, drawn) + " ms, labels " + ms(drawn, done) + " ms";
}

std::string gl_description() {
  return GlContext(16, 16).description();
}

}  // namespace render
