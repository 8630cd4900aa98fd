#include "engine/world.h"

#include <algorithm>

#include "engine/effects/effects.h"
#include "engine/laws/compliant_contact.h"

namespace engine {

namespace {

/// Joints that do not hold: none, or all when the effect is forced off.
std::vector<char> apart(const Model& model, const Plan& plan) {
  const bool held = model.joints.empty() || std::find(plan.active.begin(), plan.active.end(), &kJointsEffect) != plan.active.end();
  return std::vector<char>(model.joints.size(), static_cast<char>(!held));
}

}  // namespace

World::World(const Model& m, const Plan& p, const RunOptions& o)
    : model(m),
      plan(p),
      options(o),
      topology(build_topology(m, apart(m, p))),
      smooth(m, topology.loops.empty() ? Articulation::Keeps::last_tree : Articulation::Keeps::all_trees),
      impulse(m, Articulation::Keeps::all_trees),
      loops(m),
      meter(o.clock) {
  memory.resize(p.active.size());
  for (const Effect* effect : p.active) meter.effects.push_back({effect->name, 0, 0});
  smooth.reset(topology);
  impulse.reset(topology);
  loops.reset(topology);
  const std::size_t n = m.bodies.size();
  reach.assign(n, 0);
  awake.assign(n, 1);
  for (std::size_t b = 0; b < n; ++b) {
    const Body& body = m.bodies[b];
    if (body.fixed) awake[b] = 0;
    if (const auto* shape = std::get_if<HyperEllipsoid>(&body.shape)) reach[b] = shape->semi_axes.norm();
    if (const auto* shape = std::get_if<MeshShape>(&body.shape)) {
      const Aabb& box = shape->mesh->bounds();
      const Vec3 far = box.lower.cwiseAbs().cwiseMax(box.upper.cwiseAbs());
      reach[b] = far.norm() + shape->X_BM.p.norm();
    }
  }
  for (const Topology::Tree& tree : topology.trees) {
    double mass = 0;
    for (int l = tree.begin; l < tree.end; ++l) mass += m.bodies[topology.links[l].body].mass;
    tree_mass.push_back(mass);
  }
  dampers.resize(m.joints.size());
  resistances.resize(m.joints.size());
  constraints.reserve(kRoom);
  solver.reserve(topology, kRoom);
  active_trees.reserve(topology.trees.size());
  events.reserve(kRoom);
}

namespace {
constexpr double kSpare = 2e-3;  // [m] so that a contact is known before it is needed
}

void Nearness::look(const World& world, const State& state) {
  constexpr double kRounding = 1 + 1e-9;  // so that a bound stays one
  const std::size_t bodies = state.X_WB.size();
  swept_.resize(bodies);
  for (std::size_t b = 0; b < bodies; ++b) {
    const double way = world.step * (state.V_WB[b].v.norm() + state.V_WB[b].w.norm() * world.reach[b]);
    swept_[b] = kRounding * (world.reach[b] + way);
  }
  spare_ = kRounding * (kSpare + world.model.settings.gravity.norm() * world.step * world.step);
  const std::size_t trees = world.topology.trees.size();
  if (trees < 2) return;
  centre_.resize(trees);
  radius_.resize(trees);
  close_.resize(trees * trees);
  for (std::size_t t = 0; t < trees; ++t) {
    const Topology::Tree& range = world.topology.trees[t];
    centre_[t] = state.X_WB[world.topology.links[range.begin].body].p;
    radius_[t] = 0;
    for (int l = range.begin; l < range.end; ++l) {
      const int b = world.topology.links[l].body;
      radius_[t] = std::max(radius_[t], (state.X_WB[b].p - centre_[t]).norm() + swept_[b]);
    }
  }
  for (std::size_t a = 0; a < trees; ++a)
    for (std::size_t b = a + 1; b < trees; ++b) {
      const double within = radius_[a] + radius_[b] + 2 * spare_;
      close_[a * trees + b] = close_[b * trees + a] = static_cast<char>((centre_[a] - centre_[b]).squaredNorm() <= within * within);
    }
}

double contact_margin(const World& world, const State& state, int body) {
  const Twist& V = state.V_WB[body];
  const double g = world.model.settings.gravity.norm();
  return kSpare + world.step * (V.v.norm() + V.w.norm() * world.reach[body] + g * world.step);
}

double pair_margin(const World& world, const State& state, int a, int b) {
  const double g = world.model.settings.gravity.norm();
  const double apart = (state.X_WB[a].p - state.X_WB[b].p).norm();
  // a point of one body within reach of the other moves with either rotation
  const double turning =
      (state.V_WB[a].w.norm() * world.reach[a]) + state.V_WB[b].w.norm() * std::min(world.reach[b], apart + world.reach[a]);
  return kSpare + world.step * ((state.V_WB[a].v - state.V_WB[b].v).norm() + turning + g * world.step);
}

double World::overlap_at_start(int a, int b) const {
  double depth = 0;
  for (const Overlap& met : overlaps)
    if (std::minmax(met.a, met.b) == std::minmax(a, b)) depth = std::max(depth, met.depth);
  return depth;
}

void warn_of_overlap(World& world, int a, int b, double gap) {
  constexpr double kTold = 1e-3;  // [m]
  if (gap > -kTold) return;
  auto name = [&](int body) { return body >= 0 ? world.model.bodies[body].name : std::string("the ground"); };
  world.overlaps.push_back({a, b, -gap});
  world.diagnostics.warnings.push_back(name(a) + " and " + name(b) + " overlap by " + std::to_string(std::lround(-gap * 1e3)) +
                                       " mm at the start; they are moved apart gently");
}

void add_contact(World& world, const State& state, const SurfaceContact& touch, int a, int b, int effect, ContactKind kind,
                 double friction, double restitution) {
  Constraint c;
  c.kind = ConstraintKind::contact;
  c.rows = 3;
  auto moving = [&](int body) { return body >= 0 && !world.model.bodies[body].fixed ? body : -1; };
  c.body_a = moving(a);
  c.body_b = moving(b);
  if (c.body_a < 0 && c.body_b < 0) return;
  c.record_a = a;
  c.record_b = b;
  c.friction = friction;
  c.restitution = restitution;
  double share_a = 0.5;  // of the depth that surface a gives way by
  if (world.model.settings.contact_law == ContactLaw::compliant) {
    auto stiffness = [&](int body) {
      return (body >= 0 ? world.model.bodies[body].surface : world.model.ground.surface).stiffness.at(state.time);
    };
    const double S_a = stiffness(a), S_b = stiffness(b);
    c.stiffness = stiffness_in_series(S_a, S_b);
    c.hysteresis = restitution;
    c.restitution = 0;
    share_a = S_b / (S_a + S_b);  // depth_a S_a = depth_b S_b, eq. (81)
  }
  const Vec3 way = touch.p_b - touch.p_a, along = way.dot(touch.normal) * touch.normal;
  c.point = touch.p_a + share_a * along + touch.share_across * (way - along);
  const Vec3 t1 = touch.normal.unitOrthogonal();
  c.frame << touch.normal, t1, touch.normal.cross(t1);
  auto rows = [&](int body, double sign) {
    Eigen::Matrix<double, 3, 6> J;
    const Vec3 r = c.point - state.X_WB[body].p;
    for (int k = 0; k < 3; ++k) {
      const Vec3 d = sign * c.frame.col(k);
      J.row(k) << d.transpose(), r.cross(d).transpose();
    }
    return J;
  };
  if (c.body_a >= 0) c.J_a = rows(c.body_a, 1);
  if (c.body_b >= 0) c.J_b = rows(c.body_b, -1);
  int last_tree = -1;
  for (const int body : {c.body_a, c.body_b}) {
    if (body < 0) continue;
    c.free_response += 1 / world.model.bodies[body].mass;
    const int tree = world.topology.tree_of_body[body];
    if (tree != last_tree) c.whole_response += 1 / world.tree_mass[tree];
    last_tree = tree;
  }
  c.gap = touch.gap;
  c.key = (static_cast<std::uint64_t>(effect) << 56) | (static_cast<std::uint64_t>(a & 0xffff) << 40) |
          (static_cast<std::uint64_t>(b & 0xffff) << 24) | (touch.key & 0xffffffu);
  c.effect = effect;
  c.contact_kind = kind;
  world.constraints.push_back(c);
}

void share_stiffness(World& world, std::size_t first) {
  constexpr double kLeast = 1e-6;  // [m] what hardly touches has hardly a share
  std::vector<Constraint>& all = world.constraints;
  if (world.model.settings.contact_law != ContactLaw::compliant || all.size() < first + 2) return;
  for (std::size_t i = first; i < all.size(); ++i) {
    double sum = 0;
    for (std::size_t j = first; j < all.size(); ++j)
      sum += std::max(-all[j].gap, kLeast) * std::max(0.0, all[i].frame.col(0).dot(all[j].frame.col(0)));
    all[i].stiffness *= std::max(-all[i].gap, kLeast) / sum;
  }
}

Vec6 velocity_of(const State& state, int body) {
  Vec6 V = Vec6::Zero();
  if (body >= 0) V << state.V_WB[body].v, state.V_WB[body].w;
  return V;
}

Vec3 row_velocity(const Constraint& c, const std::vector<Twist>& V_WB) {
  Vec3 u = Vec3::Zero();
  auto add = [&](int body, const Eigen::Matrix<double, 3, 6>& J) {
    if (body < 0) return;
    const Twist& V = V_WB[body];
    for (int r = 0; r < c.rows; ++r) u[r] += J.row(r).head<3>().dot(V.v) + J.row(r).tail<3>().dot(V.w);
  };
  add(c.body_a, c.J_a);
  add(c.body_b, c.J_b);
  return u;
}

double kinetic_energy(const Model& model, const State& state) {
  double energy = 0;
  for (std::size_t b = 0; b < model.bodies.size(); ++b) {
    const Body& body = model.bodies[b];
    if (body.fixed) continue;
    const Vec3 w_B = state.X_WB[b].q.conjugate() * state.V_WB[b].w;
    energy += 0.5 * body.mass * state.V_WB[b].v.squaredNorm() + 0.5 * w_B.dot(body.inertia_B * w_B);
  }
  return energy;
}

double potential_energy(const Model& model, const State& state) {
  double energy = 0;
  for (std::size_t b = 0; b < model.bodies.size(); ++b)
    if (!model.bodies[b].fixed) energy -= model.bodies[b].mass * model.settings.gravity.dot(state.X_WB[b].p);
  return energy;
}

}  // namespace engine
