// How light the bodies of a condition are: its response were they free of joints.
#pragma once

#include <vector>

#include "engine/model/model.h"
#include "engine/solver/articulation.h"
#include "engine/solver/constraint.h"

namespace engine {

/// [1/kg] velocity along row `row` that a unit impulse along it gives, with the bodies at these poses.
inline double free_response(const Model& model, const std::vector<Pose>& X_WB, const Constraint& c, int row) {
  double response = 0;
  const auto add = [&](int b, const auto& J) {
    if (b < 0) return;
    const Vec3 v = J.row(row).template head<3>(), w = J.row(row).template tail<3>();
    response += v.squaredNorm() / model.bodies[b].mass;
    if (!w.isZero(0)) response += w.dot(inertia_W(model.bodies[b], X_WB[b].q).inverse() * w);
  };
  add(c.a.body, c.a.J);
  add(c.b.body, c.b.J);
  return response;
}

}  // namespace engine
