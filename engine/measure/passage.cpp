#include "engine/measure/passage.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "engine/geometry/hyper_ellipsoid.h"

namespace engine {
namespace {

struct Passage {
  double time = 0;  // [s]
  int object = -1;  // body
};

/// Does the way from one place to another cross a triangle?
bool crosses(const Vec3& from, const Vec3& to, const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 way = to - from, e = b - a, f = c - a, across = way.cross(f), off = from - a;
  const double volume = e.dot(across);  // Moeller and Trumbore, 1997
  if (volume == 0) return false;
  const Vec3 aside = off.cross(e);
  const double u = off.dot(across) / volume, v = way.dot(aside) / volume, t = f.dot(aside) / volume;
  return u >= 0 && v >= 0 && u + v <= 1 && t >= 0 && t <= 1;
}

/// Did a place go through the surface of a body, or into it?
bool went_in(const Body& body, const Vec3& from_B, const Vec3& to_B, std::vector<int>& triangles) {
  if (const auto* shape = std::get_if<HyperEllipsoid>(&body.shape)) {
    constexpr int kParts = 16;  // [-] of the way of a recorded interval: some centimetres
    for (int k = 1; k <= kParts; ++k)
      if (gauge(*shape, from_B + k / double{kParts} * (to_B - from_B)) < 1) return true;
    return false;
  }
  const auto& shape = std::get<MeshShape>(body.shape);
  const Pose X_MB = shape.X_BM.inverse();
  const Vec3 from = X_MB * from_B, to = X_MB * to_B;
  triangles.clear();
  shape.mesh->query({from.cwiseMin(to), from.cwiseMax(to)}, triangles);
  return std::any_of(triangles.begin(), triangles.end(), [&](int t) {
    const Triangle& at = shape.mesh->triangles()[static_cast<std::size_t>(t)];
    const auto corner = [&](std::size_t k) { return shape.mesh->vertices()[static_cast<std::size_t>(at[k])]; };
    return crosses(from, to, corner(0), corner(1), corner(2));
  });
}

std::optional<Passage> passage_of(const Model& model, const Recording& recording, int vehicle) {
  const int body = model.vehicles[static_cast<std::size_t>(vehicle)].body;
  if (!yields(model.settings.contact_law, false)) return std::nullopt;
  std::set<int> struck;
  std::vector<int> triangles;
  const Snapshot* before = &recording.snapshots.front();
  for (const Snapshot& s : recording.snapshots) {
    for (const ContactRecord& c : s.contacts)
      if (c.body_b >= 0 && (c.body_a == body || c.body_b == body)) struck.insert(c.body_a == body ? c.body_b : c.body_a);
    for (const int other : struck) {
      const Body& object = model.bodies[static_cast<std::size_t>(other)];
      if (object.person >= 0) continue;
      const auto centre = [&](const Snapshot& at) {
        return at.bodies[static_cast<std::size_t>(other)].X_WB.inverse() * at.bodies[static_cast<std::size_t>(body)].X_WB.p;
      };
      if (went_in(object, centre(*before), centre(s), triangles)) return Passage{s.time, other};
    }
    before = &s;
  }
  return std::nullopt;
}

}  // namespace

std::optional<double> went_through(const Model& model, const Recording& recording, int vehicle) {
  const auto passage = passage_of(model, recording, vehicle);
  return passage ? std::optional(passage->time) : std::nullopt;
}

std::vector<std::string> passages(const Model& model, const Recording& recording) {
  std::vector<std::string> out;
  for (int v = 0; v < static_cast<int>(model.vehicles.size()); ++v)
    if (const auto passage = passage_of(model, recording, v))
      out.push_back(
          model.vehicles[static_cast<std::size_t>(v)].name + " went into " +
          model.bodies[static_cast<std::size_t>(passage->object)].name + " as deep as its centre of mass at " +
          std::to_string(std::lround(1e3 * passage->time)) +
          " ms, farther than any vehicle gives way: do not rely on motion from there on; more stiffness may hold it out, or "
          "contact_law = \"default_auto\"");
  return out;
}

}  // namespace engine
