#include "scenes/loader/mesh_frame.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace scenes {
namespace {

using engine::Mat3;
using engine::Vec3;

struct LengthUnit {
  double metres;
  const char* name;
};
constexpr LengthUnit kLengthUnits[] = {{0.001, "millimetres"}, {0.01, "centimetres"}, {0.0254, "inches"}, {0.3048, "feet"}};

constexpr const char* kAxes[] = {"x", "y", "z", "-x", "-y", "-z"};

Vec3 axis_of(int choice) {
  return (choice < 3 ? 1 : -1) * Vec3::Unit(choice % 3);
}

/// Rows are our x, y, z in the file's axes.
Mat3 turn_of(int up, int forward) {
  Mat3 turn;
  turn.row(0) = axis_of(forward);
  turn.row(2) = axis_of(up);
  turn.row(1) = axis_of(up).cross(axis_of(forward));
  return turn;
}

constexpr int kUp = 2, kForward = 0;  // ours: z and x

/// The two axes the scene gives; of one alone the other keeps our convention as far as it can.
std::array<int, 2> given_axes(Reader& r, const MeshFrameGiven& given) {
  int up = given.up ? static_cast<int>(*given.up) : -1, forward = given.forward ? static_cast<int>(*given.forward) : -1;
  if (up < 0) up = forward % 3 == kUp ? 1 : kUp;
  if (forward < 0) forward = up % 3 == kForward ? 1 : kForward;
  if (up % 3 == forward % 3) {
    r.fail("mesh_forward", "must be another axis than mesh_up");
    return {kUp, kForward};
  }
  return {up, forward};
}

/// How far the middle of the surface lies off the middle of the box, over the box's size; about nothing across a vehicle.
Vec3 lopsidedness(const engine::TriangleMesh& mesh) {
  Vec3 middle = Vec3::Zero();
  double area = 0;
  for (const engine::Triangle& t : mesh.triangles()) {
    const auto corner = [&](int i) { return mesh.vertices()[static_cast<std::size_t>(t[static_cast<std::size_t>(i)])]; };
    const double a = (corner(1) - corner(0)).cross(corner(2) - corner(0)).norm();
    middle += a * (corner(0) + corner(1) + corner(2)) / 3;
    area += a;
  }
  const Vec3 size = mesh.bounds().upper - mesh.bounds().lower;
  return ((middle / area - 0.5 * (mesh.bounds().upper + mesh.bounds().lower)).cwiseAbs().array() / size.array()).matrix();
}

void infer_axes(Reader& r, const engine::TriangleMesh& mesh, MeshFrame& frame) {
  const Vec3 size = mesh.bounds().upper - mesh.bounds().lower;
  if (size.minCoeff() <= 0) return;
  int forward = 0;
  size.maxCoeff(&forward);
  const int a = (forward + 1) % 3, b = (forward + 2) % 3;
  const Vec3 off = lopsidedness(mesh);
  int up = off[a] > off[b] ? a : b;
  // only what stands out counts: the longest side by a fifth, and one of the others lopsided where the third is not; else z or y is
  // up
  if (size[forward] < 1.2 * std::max(size[a], size[b])) return;
  if (off[up] < 0.01 || off[up] < 3 * off[3 - forward - up]) up = forward == kUp ? 1 : kUp;
  if (up == kUp && forward == kForward) return;
  frame.turn = turn_of(up, forward);
  r.warn("mesh",
         fmt::format("is longest along its {} axis and lopsided along {}: taken as forward and up; write mesh_up = \"{}\" and "
                     "mesh_forward = \"{}\" to settle it, or with a minus sign the other way",
                     kAxes[forward], kAxes[up], kAxes[up], kAxes[forward]));
}

void infer_scale(Reader& r, const Vec3& units, MeshFrame& frame) {
  std::array<double, 3> size{units.x(), units.y(), units.z()};
  std::sort(size.begin(), size.end());
  const auto fits = [&](double scale, double shortest, double longest) {
    return size[2] * scale >= shortest && size[2] * scale <= longest && size[1] * scale >= 0.3 && size[1] * scale <= 4.5;
  };
  if (fits(1, 1.4, 25)) return;
  for (const LengthUnit& unit : kLengthUnits) {
    if (!fits(unit.metres, 2.5, 13)) continue;
    frame.scale = unit.metres;
    r.warn("mesh", fmt::format("measures {:.4g} by {:.4g} by {:.4g}: taken to be in {}; write mesh_scale = {} to settle it",
                               units.x(), units.y(), units.z(), unit.name, unit.metres));
    return;
  }
}

bool has_tyres(const render::Mesh& look) {
  return std::any_of(look.materials.begin(), look.materials.end(), [](const render::Material& m) {
    return m.name.find("tyre") != std::string::npos || m.name.find("tire") != std::string::npos;
  });
}

void infer_centre(Reader& r, const engine::Aabb& box, const ImportedMesh& mesh, MeshFrame& frame) {
  constexpr double kClearance = 0.18;  // [m] of bodywork without its wheels
  const Vec3 size = box.upper - box.lower, middle = 0.5 * (box.upper + box.lower);
  const double bottom = has_tyres(*mesh.look) ? 0 : kClearance;
  if (std::abs(middle.x()) > 0.25 * size.x()) frame.centre.x() = middle.x();
  if (std::abs(middle.y()) > 0.1 * size.y()) frame.centre.y() = middle.y();
  if (box.lower.z() < -0.05 || box.lower.z() > 0.5) frame.centre.z() = box.lower.z() - bottom;
  if (frame.centre.isZero()) return;
  r.warn(
      "mesh",
      fmt::format("does not stand on the ground about its origin: the origin is taken at {:.4g} {:.4g} {:.4g} m of the file; write "
                  "mesh_centre = \"{:.4g} {:.4g} {:.4g} m\" to settle it",
                  frame.centre.x(), frame.centre.y(), frame.centre.z(), frame.centre.x(), frame.centre.y(), frame.centre.z()));
}

engine::Aabb box_in(const engine::TriangleMesh& mesh, const MeshFrame& frame) {
  engine::Aabb out;
  for (const Vec3& v : mesh.vertices()) {
    const Vec3 p = frame.scale * (frame.turn * v);
    out.lower = out.lower.cwiseMin(p);
    out.upper = out.upper.cwiseMax(p);
  }
  return out;
}

}  // namespace

MeshFrame given_frame(Reader& r) {
  MeshFrame frame;
  MeshFrameGiven given;
  r.fill(given);
  frame.scale = given.scale.value_or(frame.scale);
  if (given.up || given.forward) {
    const auto [up, forward] = given_axes(r, given);
    frame.turn = turn_of(up, forward);
  }
  frame.centre = given.centre.value_or(frame.centre);
  return frame;
}

MeshFrame vehicle_frame(Reader& r, const ImportedMesh& mesh) {
  MeshFrame frame = given_frame(r);
  if (mesh.solid->empty()) return frame;
  const engine::TriangleMesh& solid = *mesh.solid->mesh();
  if (!r.has("mesh_up") && !r.has("mesh_forward")) infer_axes(r, solid, frame);
  if (!r.has("mesh_scale")) infer_scale(r, solid.bounds().upper - solid.bounds().lower, frame);
  if (!r.has("mesh_centre")) infer_centre(r, box_in(solid, frame), mesh, frame);
  return frame;
}

std::shared_ptr<const ImportedMesh> in_frame(Builder& builder, const std::shared_ptr<const ImportedMesh>& mesh,
                                             const MeshFrame& frame) {
  if (!mesh || (frame.scale == 1 && frame.turn.isIdentity() && frame.centre.isZero())) return mesh;
  std::string key = fmt::format("{} {}", fmt::ptr(mesh.get()), frame.scale);
  for (int i = 0; i < 9; ++i) key += fmt::format(" {}", frame.turn(i));
  for (int i = 0; i < 3; ++i) key += fmt::format(" {}", frame.centre[i]);
  auto& kept = builder.meshes[key];
  if (kept) return kept;
  const engine::TriangleMesh& solid = *mesh->solid->mesh();
  std::vector<Vec3> vertices = solid.vertices();
  for (Vec3& v : vertices) v = frame.scale * (frame.turn * v) - frame.centre;
  auto look = std::make_shared<render::Mesh>(*mesh->look);
  for (std::size_t i = 0; i + 2 < look->positions.size(); i += 3) {
    const auto vec = [i](const std::vector<float>& a) { return Vec3(a[i], a[i + 1], a[i + 2]); };
    const Vec3 p = frame.scale * (frame.turn * vec(look->positions)) - frame.centre, n = frame.turn * vec(look->normals);
    for (int k = 0; k < 3; ++k) {
      look->positions[i + static_cast<std::size_t>(k)] = static_cast<float>(p[k]);
      look->normals[i + static_cast<std::size_t>(k)] = static_cast<float>(n[k]);
    }
  }
  auto out = std::make_shared<ImportedMesh>();
  out->solid = std::make_shared<Solid>(engine::WeldedTriangles(std::move(vertices), solid.triangles()));
  out->look = std::move(look);
  kept = out;
  return kept;
}

}  // namespace scenes
