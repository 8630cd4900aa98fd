#include "engine/contact/mean_friction.h"

#include <algorithm>

#include "engine/geometry/small_vector.h"

namespace engine {
namespace {

constexpr int kMost = 32;  // knots and edges in one step; what is beyond them is not told apart
using Cuts = SmallVector<double, kMost>;

void cut(Cuts& cuts, double time, const StepWay& way) {
  if (time > way.time && time < way.time + way.length && !cuts.full()) cuts.push_back(time);
}

void cut_at_knots(Cuts& cuts, const Schedule& schedule, const StepWay& way) {
  for (const Schedule::Knot& knot : schedule.knots()) cut(cuts, knot.time, way);
}

void cut_at_edges(Cuts& cuts, const Ground& ground, const StepWay& way) {
  cut_at_knots(cuts, ground.surface.friction_ground, way);
  for (const GroundPatch& patch : ground.patches) {
    cut_at_knots(cuts, patch.friction, way);
    for (int axis = 0; axis < 2; ++axis)
      for (const double edge : {patch.lower[axis], patch.upper[axis]})
        if (way.velocity[axis] != 0) cut(cuts, way.time + (edge - way.from[axis]) / way.velocity[axis], way);
  }
}

/// Between two cuts the friction is linear in time: the middle stands for it.
template <class At>
double mean_between(Cuts& cuts, const StepWay& way, const At& at) {
  if (cuts.empty()) return at(way.time + 0.5 * way.length);
  std::sort(cuts.begin(), cuts.end());
  double sum = 0, from = way.time;
  const auto add = [&](double to) {
    sum += (to - from) * at(0.5 * (from + to));
    from = to;
  };
  for (const double time : cuts) add(time);
  add(way.time + way.length);
  return sum / way.length;
}

Vec3 place_at(const StepWay& way, double time) {
  return way.from + (time - way.time) * way.velocity;
}

}  // namespace

double mean_friction(const Schedule& friction, const StepWay& way) {
  Cuts cuts;
  cut_at_knots(cuts, friction, way);
  return mean_between(cuts, way, [&](double t) { return friction.at(t); });
}

double mean_friction(const Ground& ground, const StepWay& way) {
  Cuts cuts;
  cut_at_edges(cuts, ground, way);
  return mean_between(cuts, way, [&](double t) { return ground.friction_at(place_at(way, t), t); });
}

double mean_friction(const Body& body, const Ground& ground, const StepWay& way) {
  Cuts cuts;
  cut_at_edges(cuts, ground, way);
  cut_at_knots(cuts, body.surface.friction_ground, way);
  return mean_between(
      cuts, way, [&](double t) { return std::min(body.surface.friction_ground.at(t), ground.friction_at(place_at(way, t), t)); });
}

double mean_friction(const Body& a, const Body& b, const StepWay& way) {
  Cuts cuts;
  cut_at_knots(cuts, a.surface.friction_body, way);
  cut_at_knots(cuts, b.surface.friction_body, way);
  return mean_between(cuts, way, [&](double t) { return std::min(a.surface.friction_body.at(t), b.surface.friction_body.at(t)); });
}

bool friction_varies(const Model& model) {
  const auto changes = [](const Body& body) {
    return !body.surface.friction_ground.constant() || !body.surface.friction_body.constant();
  };
  return !model.ground.patches.empty() || !model.ground.surface.friction_ground.constant() ||
         std::any_of(model.bodies.begin(), model.bodies.end(), changes);
}

}  // namespace engine
