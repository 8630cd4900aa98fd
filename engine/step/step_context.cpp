#include "engine/step_context.h"

#include "engine/effects/effect.h"

namespace engine {

StepBuffers::StepBuffers(const World& world) {
  const std::size_t bodies = world.model.bodies.size(), joints = world.model.joints.size(), trees = world.topology.trees.size();
  for (Motion* motion : {&end, &smooth, &whole}) {
    motion->X_WB.resize(bodies);
    motion->V_WB.resize(bodies);
  }
  for (auto* list : {&constraints, &end_contacts}) list->reserve(kRoom);
  dampers.resize(joints);
  resistances.resize(joints);
  force.assign(bodies, Vec6::Zero());
  displacing = result = force;
  islands.members.resize(trees);
  for (auto& island : islands.members) island.reserve(kRoom);
  islands.ends.reserve(kRoom);
  islands.roots.reserve(trees);
  islands.of_tree.reserve(trees);
  for (auto* by : {&islands.by_whole, &islands.to_end}) by->reserve(trees);
  islands.reports.resize(trees);
  for (auto* list : {&islands.rise, &islands.left}) list->reserve(trees);
  islands.moved.assign(trees, 0);
  for (auto* list : {&islands.line, &islands.place}) list->reserve(trees);
  for (auto* list : {&weight, &allowed, &targets}) list->reserve(kRoom);
  share.reserve(trees);
  loosened.reserve(trees);
  shown.reserve(kRoom);
  pull.reserve(kRoom);
  members.reserve(kRoom);
  for (auto* list : {&dissipated_before, &given}) list->reserve(world.effects.size());
}

StepContext::StepContext(World& w, State& s, StepBuffers& b, double h)
    : world(w), state(s), buffers(b), length(h), constraints(b.constraints), end(b.end) {
  constraints.clear();
  auto contact = state.contacts.list.begin();
  for (const std::size_t e : world.taking_part(Hook::find)) {
    while (contact != state.contacts.list.end() && contact->effect <= static_cast<int>(e)) constraints.push_back(*contact++);
    const Meter::Span span(world.meter, e);
    world.effects[e]->find(*this);
  }
  constraints.insert(constraints.end(), contact, state.contacts.list.end());
  for (Constraint& c : constraints) c.u.before = row_velocity(c, state.V_WB);
}

Vec3 row_velocity(const Constraint& c, const std::vector<Twist>& V_WB) {
  Vec3 u = Vec3::Zero();
  // columns first: rows would be summed in another order, and every recording would change in its last bits
  auto add = [&](int body, const Eigen::Matrix<double, 3, 6>& J) {
    if (body < 0) return;
    const Twist& V = V_WB[body];
    for (int r = 0; r < c.rows; ++r) u[r] += J.row(r).head<3>().dot(V.v) + J.row(r).tail<3>().dot(V.w);
  };
  add(c.a.body, c.a.J);
  add(c.b.body, c.b.J);
  return u;
}

}  // namespace engine
