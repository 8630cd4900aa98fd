#include "engine/measure/passage.h"

#include <algorithm>
#include <cmath>
#include <map>
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

/// Places [m], body axes, across a vehicle at its centre of mass. Those aside count for what was first met at one of its ends: what
/// is pressed into a flank comes as near.
std::vector<Vec3> across(const Body& vehicle, const Vec3& met_B) {
  constexpr double kOfLength = 0.6, kOfWidth = 0.75;  // [-] of the halves
  std::vector<Vec3> out{Vec3::Zero()};
  const auto* shape = std::get_if<MeshShape>(&vehicle.shape);
  if (!shape) return out;
  const Vec3 middle = shape->X_BM * (0.5 * (shape->mesh->bounds().lower + shape->mesh->bounds().upper)),
             half = 0.5 * (shape->mesh->bounds().upper - shape->mesh->bounds().lower);
  if (std::abs(met_B.x() - middle.x()) < kOfLength * half.x()) return out;
  for (const double side : {-1.0, -0.75, -0.5, -0.25, 0.25, 0.5, 0.75, 1.0})
    out.emplace_back(0, middle.y() + side * kOfWidth * half.y(), 0);
  return out;
}

std::optional<Passage> passage_of(const Model& model, const Recording& recording, int vehicle) {
  const int body = model.vehicles[static_cast<std::size_t>(vehicle)].body;
  if (!yields(model.settings.contact_law, false)) return std::nullopt;
  std::map<int, std::vector<Vec3>> struck;  // by body: what must not get into it
  std::vector<int> triangles;
  const Snapshot* before = &recording.snapshots.front();
  const auto pose = [](const Snapshot& s, int b) -> const Pose& { return s.bodies[static_cast<std::size_t>(b)].X_WB; };
  for (const Snapshot& s : recording.snapshots) {
    for (const ContactRecord& c : s.contacts) {
      const int other = c.body_a == body ? c.body_b : c.body_b == body ? c.body_a : -1;
      if (other >= 0 && !struck.contains(other) && model.bodies[static_cast<std::size_t>(other)].person < 0)
        struck[other] = across(model.bodies[static_cast<std::size_t>(body)], pose(s, body).inverse() * c.point);
    }
    for (const auto& met : struck) {
      const int other = met.first;
      for (const Vec3& place : met.second) {
        const auto seen = [&](const Snapshot& at) { return pose(at, other).inverse() * (pose(at, body) * place); };
        if (went_in(model.bodies[static_cast<std::size_t>(other)], seen(*before), seen(s), triangles))
          return Passage{s.time, other};
      }
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
