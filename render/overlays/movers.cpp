#include "render/overlays/movers.h"

namespace render {
namespace {

/// Mean over the parts by mass; `of` gives what is asked of a body.
template <typename Of>
Vec3 mean(const Mover& mover, const engine::Snapshot& s, Of of) {
  if (mover.masses.empty()) return of(s.bodies[static_cast<std::size_t>(mover.body)]);
  Vec3 sum = Vec3::Zero();
  double mass = 0;
  for (const auto& [body, m] : mover.masses) {
    sum += m * of(s.bodies[static_cast<std::size_t>(body)]);
    mass += m;
  }
  return sum / mass;
}

}  // namespace

Vec3 centre_of(const Mover& mover, const engine::Snapshot& s) {
  return mean(mover, s, [](const engine::BodyState& b) { return b.X_WB.p; });
}

Vec3 velocity_of(const Mover& mover, const engine::Snapshot& s) {
  return mean(mover, s, [](const engine::BodyState& b) { return b.V_WB.v; });
}

}  // namespace render
