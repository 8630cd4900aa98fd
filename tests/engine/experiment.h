// A small language for textbook experiments on the engine.
#pragma once

#include <cmath>
#include <numbers>

#include "engine/plan.h"
#include "engine/simulate.h"

namespace engine::test {

inline Body solid(const HyperEllipsoid& shape, double mass, const Vec3& at) {
  Body body;
  body.name = "body";
  body.mass = mass;
  body.shape = shape;
  body.inertia_B = principal_inertia(shape, mass).asDiagonal();
  body.X_WB.p = at;
  return body;
}

inline Body ball(double radius, double mass, const Vec3& at) {
  return solid({Vec3::Constant(radius), 2}, mass, at);
}

/// A body without a surface: only mass and inertia.
inline Body inert(double mass, const Vec3& inertia, const Vec3& at) {
  Body body;
  body.name = "body";
  body.mass = mass;
  body.inertia_B = inertia.asDiagonal();
  body.X_WB.p = at;
  return body;
}

/// Joint of kind at a world point between two bodies of the model as they stand, frames along the world's axes turned by q_WF.
inline Joint joint_at(const Model& model, JointKind kind, int parent, int child, const Vec3& point,
                      const Quat& q_WF = Quat::Identity()) {
  Joint joint;
  joint.name = "joint";
  joint.kind = kind;
  joint.parent = parent;
  joint.child = child;
  const Pose X_WF{point, q_WF};
  joint.X_PF = parent < 0 ? X_WF : model.bodies[parent].X_WB.inverse() * X_WF;
  joint.X_CF = model.bodies[child].X_WB.inverse() * X_WF;
  return joint;
}

/// Somebody of one body, awake from the start.
inline Person of_one_part(int body) {
  Person person;
  person.name = "person";
  person.bodies = {body};
  person.head = person.hips = body;
  person.zero_condition = false;
  return person;
}

inline Model free_space(double duration, double step = 1e-3) {
  Model model;
  model.ground.plane = false;
  model.settings.gravity.setZero();
  model.settings.duration = duration;
  model.settings.step = step;
  model.settings.stop_at_rest = false;
  model.settings.effects["air_drag"] = Force::off;  // as in the formulas
  return model;
}

inline Model on_ground(double duration, double step = 1e-3) {
  Model model;
  model.settings.duration = duration;
  model.settings.step = step;
  model.settings.stop_at_rest = false;
  model.settings.effects["air_drag"] = Force::off;  // as in the formulas
  return model;
}

inline Vec3 angular_momentum(const Model& model, const Snapshot& s) {
  Vec3 L = Vec3::Zero();
  for (std::size_t b = 0; b < model.bodies.size(); ++b) {
    const auto& [X, V] = s.bodies[b];
    L += X.q * (model.bodies[b].inertia_B * (X.q.conjugate() * V.w)) + model.bodies[b].mass * X.p.cross(V.v);
  }
  return L;
}

inline double mechanical_energy(const Snapshot& s) {
  return s.energies.kinetic + s.energies.potential;
}

}  // namespace engine::test
