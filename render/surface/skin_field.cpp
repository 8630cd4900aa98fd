#include "render/surface/skin_field.h"

#include <algorithm>
#include <cmath>

namespace render {
namespace {

constexpr double kLateral = 0.03;       // [m] a joint farther off the middle plane begins a limb
constexpr double kArm = 0.75;           // [rad] limbs are spread by so much, arms more than legs
constexpr double kLeg = 0.30;           // [rad]
constexpr double kFillet = 0.7;         // [-] of the thinner segment's girth
constexpr double kWidestFillet = 0.05;  // [m]
constexpr double kBall = 0.93;          // [-] of the thinner segment's girth
constexpr double kShoulderBall = 0.60;  // [-] where an arm begins

double girth(const engine::HyperEllipsoid& e) {
  return std::min(e.semi_axes.x(), e.semi_axes.y());
}

}  // namespace

SkinField::SkinField(const PersonActor& person) : person_(person), X_MS_(person.segments.size()) {
  const auto& segments = person.segments;
  std::vector<bool> placed(segments.size(), false);
  // parents first, in whatever order they are written
  for (std::size_t round = 0; round < segments.size(); ++round)
    for (std::size_t i = 0; i < segments.size(); ++i) {
      const PersonActor::Segment& s = segments[i];
      if (placed[i] || (s.parent >= 0 && !placed[static_cast<std::size_t>(s.parent)])) continue;
      placed[i] = true;
      if (s.parent < 0) continue;
      const std::size_t p = static_cast<std::size_t>(s.parent);
      const PersonActor::Segment& parent = segments[p];
      const Vec3 joint_S = s.X_WB.inverse() * (parent.X_WB * s.joint_P), joint_M = X_MS_[p] * s.joint_P;
      Pose& X = X_MS_[i];
      X.q = X_MS_[p].q;
      // a limb that hangs from the upper half of its parent is an arm
      const bool limb = std::abs(s.joint_P.y()) > kLateral && joint_S.z() > 0;
      if (limb)
        X.q = X.q * engine::Quat(Eigen::AngleAxisd(std::copysign(s.joint_P.z() > 0 ? kArm : kLeg, s.joint_P.y()), Vec3::UnitX()));
      X.p = joint_M - X.q * joint_S;
      const double thin = std::min(girth(s.shape), girth(parent.shape));
      joints_.push_back(
          {p, i, joint_M, (limb && s.joint_P.z() > 0 ? kShoulderBall : kBall) * thin, std::min(kFillet * thin, kWidestFillet)});
    }
  for (std::size_t i = 0; i < segments.size(); ++i) {
    const Pose X_SM = X_MS_[i].inverse();
    const bool mirrored = segments[i].name.find("right_") != std::string::npos;
    looks_.push_back({anatomy_of(segments[i].name), mirrored, X_SM.q.toRotationMatrix(), X_SM.p});
  }
}

double SkinField::at(const Vec3& x, std::vector<double>& distances) const {
  distances.resize(X_MS_.size());
  double least = 1e9;
  for (std::size_t i = 0; i < X_MS_.size(); ++i) {
    const engine::HyperEllipsoid& shape = person_.segments[i].shape;
    const Look& look = looks_[i];
    const Vec3 x_S = look.R_SM * x + look.p_SM;
    distances[i] = look.anatomy ? anatomical_distance(*look.anatomy, shape, look.mirrored, x_S) : radial_distance(shape, x_S);
    least = std::min(least, distances[i]);
  }
  for (const Joint& j : joints_) {
    const double both = smooth_minimum(distances[j.parent], distances[j.child], j.blend);
    least = std::min(least, smooth_minimum(both, (x - j.centre).norm() - j.radius, j.blend));
  }
  return least;
}

Vec3 SkinField::normal(const Vec3& x) const {
  constexpr double kStep = 1e-4;  // [m]
  std::vector<double> unused;
  Vec3 g;
  for (int i = 0; i < 3; ++i) g[i] = at(x + kStep * Vec3::Unit(i), unused) - at(x - kStep * Vec3::Unit(i), unused);
  const double length = g.norm();
  return length > 0 ? Vec3(g / length) : Vec3(Vec3::UnitZ());
}

Vec3 SkinField::onto_surface(Vec3 x) const {
  constexpr double kNear = 1e-9, kStep = 1e-4;  // [m]
  std::vector<double> unused;
  // Newton along the gradient: the radial distance grows faster than the true one where a long segment is met at a slant. One-sided
  // differences serve: a step that is a hundredth off costs another step at most
  for (int i = 0; i < 6; ++i) {
    const double d = at(x, unused);
    if (std::abs(d) < kNear) break;
    Vec3 g;
    for (int k = 0; k < 3; ++k) g[k] = (at(x + kStep * Vec3::Unit(k), unused) - d) / kStep;
    x -= d / std::max(g.squaredNorm(), 0.1) * g;
  }
  return x;
}

void SkinField::bounds(Vec3& lower, Vec3& upper) const {
  lower = Vec3::Constant(1e9);
  upper = Vec3::Constant(-1e9);
  for (std::size_t i = 0; i < X_MS_.size(); ++i) {
    const Vec3 half = engine::aabb_half_widths(person_.segments[i].shape, X_MS_[i].q) + Vec3::Constant(kWidestFillet);
    lower = lower.cwiseMin(X_MS_[i].p - half);
    upper = upper.cwiseMax(X_MS_[i].p + half);
  }
}

}  // namespace render
