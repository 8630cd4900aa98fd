#include "engine/contact/broad_phase.h"

#include <algorithm>
#include <limits>

#include "engine/world.h"

namespace engine {
namespace {

constexpr double kSpare = 2e-3;         // [m] so that a contact is known before it is needed
constexpr double kRounding = 1 + 1e-9;  // so that a bound stays one

}  // namespace

void BroadPhase::sweep(const Outlook& outlook, int body) {
  const Twist& V = outlook.at.V_WB[body];
  const double reach = outlook.world.reach[body];
  swept_[body] = kRounding * (reach + outlook.within * (V.v.norm() + V.w.norm() * reach));
}

void BroadPhase::enclose(const Outlook& outlook, int tree) {
  const Topology& topology = outlook.world.topology;
  const Topology::Tree& range = topology.trees[tree];
  const std::vector<Pose>& X = outlook.at.X_WB;
  Sphere& sphere = trees_[tree];
  sphere.centre = X[topology.links[range.begin].body].p;
  sphere.radius = 0;
  for (int l = range.begin; l < range.end; ++l) {
    const int b = topology.links[l].body;
    const double about = std::max(swept_[b], swept_[b] - outlook.world.reach[b] + wheels_[b]);
    sphere.radius = std::max(sphere.radius, (X[b].p - sphere.centre).norm() + about);
  }
}

/// A look at everything: at the start, and when somebody has begun or ceased to be still.
void BroadPhase::begin(const Outlook& outlook) {
  const World& world = outlook.world;
  swept_.resize(world.model.bodies.size());
  wheels_.resize(world.model.bodies.size(), 0);
  for (const Vehicle& vehicle : world.model.vehicles)
    for (const Wheel& wheel : vehicle.wheels)
      wheels_[vehicle.body] = std::max(wheels_[vehicle.body], wheel.hub_B.norm() + wheel.radius + wheel.width + 2 * wheel.travel);
  trees_.resize(world.topology.trees.size());
  close_.assign(trees_.size() * trees_.size(), 0);
  moving_.clear();
  still_.clear();
  moving_.reserve(trees_.size());
  still_.reserve(trees_.size());
  for (Sphere& sphere : trees_) sphere.moves = false;
  for (const int b : world.still.others)
    if (const int tree = world.topology.tree_of_body[b]; tree >= 0) trees_[tree].moves = true;
  for (int b = 0; b < static_cast<int>(swept_.size()); ++b) sweep(outlook, b);
  for (std::size_t t = 0; t < trees_.size(); ++t) {
    (trees_[t].moves ? moving_ : still_).push_back(t);
    trees_[t].slack = 0;
    if (!trees_[t].moves) enclose(outlook, static_cast<int>(t));
  }
  at_start_ = outlook.at.time == 0;
  begun_ = world.still.changes;
}

/// Between the spheres of two trees [m].
double BroadPhase::apart(std::size_t a, std::size_t b) const {
  return (trees_[a].centre - trees_[b].centre).norm() - (trees_[a].radius + trees_[b].radius + 2 * spare_);
}

bool BroadPhase::note(std::size_t a, std::size_t b, bool close) {
  char& known = close_[a * trees_.size() + b];
  if ((known != 0) == close) return false;
  known = close_[b * trees_.size() + a] = static_cast<char>(close);
  return true;
}

/// Which of those that are still a moving tree comes close to.
bool BroadPhase::look_at_still(std::size_t tree) {
  Sphere& sphere = trees_[tree];
  const double now = sphere.radius + 2 * spare_;
  const double nearer = (sphere.centre - sphere.measured_at).norm() + std::max(0.0, now - sphere.measured_radius);
  if (kRounding * nearer < sphere.slack) return false;
  bool changed = false;
  sphere.slack = std::numeric_limits<double>::infinity();
  for (const std::size_t other : still_) {
    const double gap = apart(tree, other);
    changed = note(tree, other, gap <= 0) || changed;
    sphere.slack = std::min(sphere.slack, gap);
  }
  sphere.measured_at = sphere.centre;
  sphere.measured_radius = now;
  return changed;
}

bool BroadPhase::look(const Outlook& outlook) {
  const World& world = outlook.world;
  const double h = outlook.within;
  spare_ = kRounding * (kSpare + world.model.settings.gravity.norm() * h * h);
  bool changed = begun_ != world.still.changes || at_start_ || outlook.at.time == 0;
  if (changed) {
    begin(outlook);
  } else {
    for (const int b : world.still.others) sweep(outlook, b);
  }
  for (const std::size_t t : moving_) enclose(outlook, static_cast<int>(t));
  for (std::size_t i = 0; i < moving_.size(); ++i) {
    if (!still_.empty()) changed = look_at_still(moving_[i]) || changed;
    for (std::size_t k = i + 1; k < moving_.size(); ++k)
      changed = note(moving_[i], moving_[k], apart(moving_[i], moving_[k]) <= 0) || changed;
  }
  for (std::size_t i = 0; at_start_ && i < still_.size(); ++i)
    for (std::size_t k = i + 1; k < still_.size(); ++k) note(still_[i], still_[k], apart(still_[i], still_[k]) <= 0);
  return changed;
}

void ContactPairs::look(const Outlook& outlook) {
  if (!broad_phase.look(outlook)) return;
  const std::vector<int>& tree = outlook.world.topology.tree_of_body;
  const auto list = [this](const auto& runs, std::vector<std::size_t>& out) {
    out.clear();
    out.reserve(runs.size());
    for (std::size_t r = 0; r < runs.size(); ++r)
      if (broad_phase.close(runs[r].tree_a, runs[r].tree_b)) out.push_back(r);
  };
  list(round, in_reach.round);
  list(mesh_runs, in_reach.mesh);
  in_reach.tyres.clear();
  for (std::size_t i = 0; i < tyres.size(); ++i)
    if (broad_phase.close(tree[tyres[i].body], tree[tyres[i].vehicle_body])) in_reach.tyres.push_back(i);
}

double contact_margin(const Outlook& outlook, int body) {
  const Twist& V = outlook.at.V_WB[body];
  const double g = outlook.world.model.settings.gravity.norm();
  return kSpare + outlook.within * (V.v.norm() + V.w.norm() * outlook.world.reach[body] + g * outlook.within);
}

double pair_margin(const Outlook& outlook, int a, int b) {
  const World& world = outlook.world;
  const Motion& at = outlook.at;
  const double g = world.model.settings.gravity.norm();
  const double apart = (at.X_WB[a].p - at.X_WB[b].p).norm();
  // a point of one body within reach of the other moves with either rotation
  const double turning =
      (at.V_WB[a].w.norm() * world.reach[a]) + at.V_WB[b].w.norm() * std::min(world.reach[b], apart + world.reach[a]);
  return kSpare + outlook.within * ((at.V_WB[a].v - at.V_WB[b].v).norm() + turning + g * outlook.within);
}

}  // namespace engine
