#include "engine/effects/underfoot.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace engine {
namespace {

constexpr double kStride = 0.7;  // [m] of a pedestrian who walks at 1.4 m/s with two steps a second
constexpr double kTrunk = 0.2;   // [m] from the middle of the hips to what they walk into
constexpr double kStep = 0.4;    // [m] that nobody takes up or down without a stumble: two stairs

}  // namespace

bool is_uneven(const Model& model) {
  return !roads_of(model).empty();
}

Underfoot::Underfoot(const Model& model) : roads_(roads_of(model)) {
  if (level()) return;
  std::vector<Pose> X_WB;
  for (const Body& body : model.bodies) X_WB.push_back(body.X_WB);
  for (const Person& person : model.persons) clearance_.push_back(clearance(model, X_WB, person));
}

double Underfoot::height_below(const Ground& ground, const Vec3& from) const {
  constexpr double kFarthest = 1e3;  // [m]
  double highest = ground.plane && ground.height <= from.z() ? ground.height : from.z() - kFarthest;
  for (const Road& road : roads_) {
    double way = 0;
    int triangle = -1;
    const bool above =
        (from.array() >= road.box.lower.array()).head<2>().all() && (from.array() <= road.box.upper.array()).head<2>().all();
    if (above && road.mesh->raycast(road.X_WM.inverse() * from, road.X_WM.q.conjugate() * -Vec3::UnitZ(), kFarthest, way, triangle))
      highest = std::max(highest, from.z() - way);
  }
  return highest;
}

bool Underfoot::is_blocked(const Vec3& from, const Vec3& way) const {
  const double far = way.norm();
  return std::any_of(roads_.begin(), roads_.end(), [&](const Road& road) {
    double met = 0;
    int triangle = -1;
    return road.mesh->raycast(road.X_WM.inverse() * from, road.X_WM.q.conjugate() * (way / far), far, met, triangle);
  });
}

double Underfoot::clearance(const Model& model, const std::vector<Pose>& X_WB, const Person& person) const {
  double lowest = std::numeric_limits<double>::infinity();
  for (const int b : person.bodies)
    if (const auto* shape = std::get_if<HyperEllipsoid>(&model.bodies[b].shape))
      lowest = std::min(lowest, X_WB[b].p.z() - support_value(*shape, X_WB[b].q.conjugate() * -Vec3::UnitZ()));
  return lowest - height_below(model.ground, X_WB[person.hips].p);
}

bool Underfoot::carries(const Model& model, const State& state, int p, int mesh_body, const Vec3& point) const {
  const int hips = model.persons[p].hips;
  const auto is_it = [mesh_body](const Road& road) { return road.body == mesh_body; };
  if (std::none_of(roads_.begin(), roads_.end(), is_it) || state.V_WB[hips].v.head<2>().isZero(0)) return false;
  return point.z() < height_below(model.ground, state.X_WB[hips].p) + kStep;
}

std::optional<double> Underfoot::rise(const Model& model, const State& state, int p) const {
  const Person& person = model.persons[p];
  const Vec3 hips = state.X_WB[person.hips].p, v = state.V_WB[person.hips].v;
  const double speed = v.head<2>().norm();
  if (speed == 0) return 0;
  const Vec3 ahead = 0.5 * kStride / speed * Vec3(v.x(), v.y(), 0);
  const double here = height_below(model.ground, hips), front = height_below(model.ground, hips + ahead),
               back = height_below(model.ground, hips - ahead);
  if (is_blocked(hips, kTrunk * ahead.normalized()) || front - here > kStep ||
      clearance(model, state.X_WB, person) > clearance_[p] + kStep)
    return std::nullopt;
  const auto on = [here](double height) { return std::abs(height - here) <= kStep ? height : here; };
  return (on(front) - on(back)) / kStride;
}

}  // namespace engine
