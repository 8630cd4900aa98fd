// Two hyper-ellipsoids: segments of one person or of several, free bodies.
#include "engine/geometry/hyper_ellipsoid_faces.h"
#include "engine/geometry/hyper_ellipsoid_pair.h"
#include "engine/world.h"

namespace engine {
namespace {

/// The distance [m] a step can bring the two together by; nothing where they are farther apart.
std::optional<double> margin_of_near(const Outlook& outlook, const ContactPair& pair) {
  const World& world = outlook.world;
  if (world.pairs.broad_phase.apart(outlook.at, pair.a, pair.b)) return std::nullopt;
  const double margin = pair_margin(outlook, pair.a, pair.b);
  const double apart = (outlook.at.X_WB[pair.a].p - outlook.at.X_WB[pair.b].p).norm();
  if (apart > world.reach[pair.a] + world.reach[pair.b] + margin) return std::nullopt;
  return margin;
}

/// Side on side at many points, else at the deepest. Where they are apart, the memory has by how much.
void contacts_of_rounds(const HyperEllipsoid& A, const Pose& X_WA, const HyperEllipsoid& B, const Pose& X_WB, double margin,
                        PairMemory& memory, ContactPoints& out) {
  double apart = 0;
  const FacesMeet faces = contacts_of_faces(A, X_WA, B, X_WB, margin, out, apart);
  if (faces == FacesMeet::apart) memory.clearance.least = apart;
  if (faces != FacesMeet::other) return;
  const Vec3 guess = X_WA.q * memory.next_normal();
  Vec3 normal = guess;
  if (const auto touch = contact_of_pair(A, X_WA, B, X_WB, margin, normal, &memory.clearance.least, &memory.others))
    out.push_back(*touch);
  memory.note_normal(X_WA.q.conjugate() * normal, normal != guess);
}

}  // namespace

template <>
Touches touches_between<ShapeKind::round, ShapeKind::round>(const Outlook& outlook, const ContactPair& pair) {
  World& world = outlook.world;
  PairMemory& memory = outlook.state.contact_memory.round[pair.run][pair.at];
  const std::optional<double> margin = margin_of_near(outlook, pair);
  if (!margin) return {};
  const Pose &X_WA = outlook.at.X_WB[pair.a], &X_WB = outlook.at.X_WB[pair.b];
  const Pose X_AB = X_WA.inverse() * X_WB;
  if (memory.clearance.beyond(*margin, X_AB, world.reach[pair.b])) return {};
  memory.clearance.least = 0;
  ContactPoints& touches = world.pairs.touches;
  touches.clear();
  contacts_of_rounds(std::get<HyperEllipsoid>(world.model.bodies[pair.a].shape), X_WA,
                     std::get<HyperEllipsoid>(world.model.bodies[pair.b].shape), X_WB, *margin, memory, touches);
  if (touches.empty()) memory.clearance.X = X_AB;
  return {touches.begin(), touches.end()};
}

}  // namespace engine
