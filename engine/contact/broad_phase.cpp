#include "engine/contact/broad_phase.h"

#include <algorithm>

#include "engine/world.h"

namespace engine {
namespace {

constexpr double kSpare = 2e-3;  // [m] so that a contact is known before it is needed

}  // namespace

void BroadPhase::look(const Outlook& outlook) {
  constexpr double kRounding = 1 + 1e-9;  // so that a bound stays one
  const World& world = outlook.world;
  const Motion& at = outlook.at;
  const double h = outlook.within;
  const std::size_t bodies = at.X_WB.size();
  swept_.resize(bodies);
  for (std::size_t b = 0; b < bodies; ++b) {
    const double way = h * (at.V_WB[b].v.norm() + at.V_WB[b].w.norm() * world.reach[b]);
    swept_[b] = kRounding * (world.reach[b] + way);
  }
  spare_ = kRounding * (kSpare + world.model.settings.gravity.norm() * h * h);
  const std::size_t trees = world.topology.trees.size();
  if (trees < 2) return;
  centre_.resize(trees);
  radius_.resize(trees);
  close_.resize(trees * trees);
  for (std::size_t t = 0; t < trees; ++t) {
    const Topology::Tree& range = world.topology.trees[t];
    centre_[t] = at.X_WB[world.topology.links[range.begin].body].p;
    radius_[t] = 0;
    for (int l = range.begin; l < range.end; ++l) {
      const int b = world.topology.links[l].body;
      radius_[t] = std::max(radius_[t], (at.X_WB[b].p - centre_[t]).norm() + swept_[b]);
    }
  }
  for (std::size_t a = 0; a < trees; ++a)
    for (std::size_t b = a + 1; b < trees; ++b) {
      const double within = radius_[a] + radius_[b] + 2 * spare_;
      close_[a * trees + b] = close_[b * trees + a] = static_cast<char>((centre_[a] - centre_[b]).squaredNorm() <= within * within);
    }
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
