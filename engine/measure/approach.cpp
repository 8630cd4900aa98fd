#include "engine/measure/approach.h"

#include <algorithm>
#include <cmath>

#include "engine/geometry/hyper_ellipsoid_mesh.h"
#include "engine/measure/parties.h"

namespace engine {
namespace {

using Point2 = Eigen::Vector2d;

constexpr double kSame = 1e-6;  // [m] two that stand hum by less: of as near instants the first tells

bool nearer(double distance, double time, const std::optional<Approach>& best) {
  if (!best || distance < best->distance - kSame) return true;
  if (distance >= best->distance + kSame) return false;
  return time == best->time ? distance < best->distance : time < best->time;
}

/// Of a vehicle with a person or a vehicle; a kerb or a wall is neither.
bool any_touch(const Model& model, const Recording& recording) {
  const auto counts = [&](int b) { return b >= 0 && (model.bodies[b].vehicle >= 0 || model.bodies[b].person >= 0); };
  for (const Snapshot& s : recording.snapshots)
    for (const ContactRecord& c : s.contacts)
      if (c.shapes.with_vehicle() && counts(c.body_a) && counts(c.body_b) && !c.impulse.isZero(0) &&
          (model.bodies[c.body_a].vehicle >= 0 || model.bodies[c.body_b].vehicle >= 0))
        return true;
  return false;
}

/// A part of a person and a vehicle at one recorded instant, and the least distance they can have there.
struct Candidate {
  double least = 0;  // [m]
  std::size_t at = 0;
  int part = -1, vehicle = -1;
};

double to_box(const Aabb& box, const Vec3& p) {
  return (p - p.cwiseMax(box.lower).cwiseMin(box.upper)).norm();
}

std::vector<Candidate> candidates(const Model& model, const Recording& recording) {
  std::vector<Candidate> out;
  for (const Vehicle& vehicle : model.vehicles) {
    const auto* mesh = std::get_if<MeshShape>(&model.bodies[vehicle.body].shape);
    if (!mesh) continue;
    for (const Person& person : model.persons) {
      if (person.mount == vehicle.body) continue;
      for (std::size_t i = 0; i < recording.snapshots.size(); ++i) {
        const auto& bodies = recording.snapshots[i].bodies;
        const Pose X_MW = (bodies[vehicle.body].X_WB * mesh->X_BM).inverse();
        for (const int b : person.bodies)
          if (const auto* shape = std::get_if<HyperEllipsoid>(&model.bodies[b].shape))
            out.push_back({to_box(mesh->mesh->bounds(), X_MW * bodies[b].X_WB.p) - shape->semi_axes.norm(), i, b, vehicle.body});
      }
    }
  }
  std::sort(out.begin(), out.end(), [](const Candidate& a, const Candidate& b) { return a.least < b.least; });
  return out;
}

std::optional<Approach> of_persons(const Model& model, const Recording& recording) {
  constexpr double kFarther = 0.5;  // [m] by which the search reaches farther until it finds anything
  MeshContactScratch scratch;
  ContactPoints touches;
  std::optional<Approach> best;
  for (const Candidate& c : candidates(model, recording)) {
    if (best && c.least >= best->distance + kSame) break;
    const auto& mesh = std::get<MeshShape>(model.bodies[c.vehicle].shape);
    const Snapshot& s = recording.snapshots[c.at];
    reserve(scratch, *mesh.mesh);
    for (double margin = best ? best->distance + kSame : std::max(c.least, 0.0) + kFarther;; margin += kFarther) {
      contacts_with_mesh(std::get<HyperEllipsoid>(model.bodies[c.part].shape), s.bodies[c.part].X_WB, *mesh.mesh,
                         s.bodies[c.vehicle].X_WB * mesh.X_BM, margin, 0, scratch, touches);
      for (const SurfaceContact& touch : touches)
        if (const double gap = std::max(touch.gap, 0.0); nearer(gap, s.time, best)) best = Approach{gap, s.time, c.part, c.vehicle};
      if (best || margin > c.least + 20) break;
    }
  }
  return best;
}

/// Convex outline seen from above, body axes (monotone chain, Andrew 1979).
std::vector<Vec3> outline(const MeshShape& shape) {
  std::vector<Vec3> p;
  for (const Vec3& v : shape.mesh->vertices()) p.push_back(shape.X_BM * v);
  std::sort(p.begin(), p.end(), [](const Vec3& a, const Vec3& b) { return a.x() != b.x() ? a.x() < b.x() : a.y() < b.y(); });
  std::vector<Vec3> hull;
  for (int side = 0; side < 2; ++side) {
    const std::size_t begin = hull.size();
    for (const Vec3& v : p) {
      const auto right = [&](const Vec3& a, const Vec3& b) {
        return (b.x() - a.x()) * (v.y() - b.y()) - (b.y() - a.y()) * (v.x() - b.x()) <= 0;
      };
      while (hull.size() > begin + 1 && right(hull[hull.size() - 2], hull.back())) hull.pop_back();
      hull.push_back(v);
    }
    if (!hull.empty()) hull.pop_back();
    std::reverse(p.begin(), p.end());
  }
  return hull;
}

std::vector<Point2> placed(const std::vector<Vec3>& outline_B, const Pose& X_WB) {
  std::vector<Point2> out;
  for (const Vec3& p : outline_B) out.push_back((X_WB * p).head<2>());
  return out;
}

/// From each corner of one to each side of the other; 0 where a corner of one lies inside the other.
double apart(const std::vector<Point2>& a, const std::vector<Point2>& b) {
  double best = 1e300;
  for (const Point2& p : a) {
    bool inside = true;
    for (std::size_t i = 0; i < b.size(); ++i) {
      const Point2 &from = b[i], side = b[(i + 1) % b.size()] - from, way = p - from;
      const double share = std::clamp(way.dot(side) / std::max(side.squaredNorm(), 1e-12), 0.0, 1.0);
      best = std::min(best, (way - share * side).norm());
      inside = inside && side.x() * way.y() - side.y() * way.x() > 0;
    }
    if (inside) return 0;
  }
  return best;
}

std::optional<Approach> of_vehicles(const Model& model, const Recording& recording) {
  std::vector<std::pair<int, std::vector<Vec3>>> outlines;
  for (const Vehicle& v : model.vehicles)
    if (const auto* shape = std::get_if<MeshShape>(&model.bodies[v.body].shape)) outlines.emplace_back(v.body, outline(*shape));
  std::optional<Approach> best;
  for (std::size_t i = 0; i < outlines.size(); ++i) {
    const int a = outlines[i].first;
    const std::vector<int> train = joined_for_good(model, {a});
    for (std::size_t k = i + 1; k < outlines.size(); ++k) {
      const int b = outlines[k].first;
      if (std::find(train.begin(), train.end(), b) != train.end()) continue;
      for (const Snapshot& s : recording.snapshots) {
        const auto at_a = placed(outlines[i].second, s.bodies[a].X_WB), at_b = placed(outlines[k].second, s.bodies[b].X_WB);
        const double d = std::min(apart(at_a, at_b), apart(at_b, at_a));
        if (nearer(d, s.time, best)) best = Approach{d, s.time, a, b};
      }
    }
  }
  return best;
}

}  // namespace

std::optional<Approach> nearest_approach(const Model& model, const Recording& recording) {
  if (any_touch(model, recording)) return std::nullopt;
  const auto person = of_persons(model, recording);
  return person ? person : of_vehicles(model, recording);
}

}  // namespace engine
