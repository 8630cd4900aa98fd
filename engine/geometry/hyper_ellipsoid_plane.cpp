#include "engine/geometry/hyper_ellipsoid_plane.h"

#include <algorithm>

#include "engine/geometry/face_corners.h"
#include "engine/math/functions.h"

namespace engine {
namespace {

/// [-] The corners of a side of half depth a stand above it by 2 a lean^(n/(n-1)) / n, to first order.
double lean_of_corners(const HyperEllipsoid& shape, int face) {
  constexpr double kHighest = 0.9 * kNoDeeper;
  const double n = shape.exponent, most = 0.5 * n * kHighest / shape.semi_axes[face];
  if (n < kFlatSides || most >= kCornerLean) return kCornerLean;
  return std::min(kCornerLean, math::pow(most, 1 - 1 / n));
}

}  // namespace

std::array<Vec3, 4> corner_directions(const HyperEllipsoid& shape, const Vec3& direction, double lean) {
  int face = 0;
  direction.cwiseAbs().maxCoeff(&face);
  const int i = (face + 1) % 3, k = (face + 2) % 3;
  const Vec3& a = shape.semi_axes;
  const double lean_i = lean * a[face] / a[i], lean_k = lean * a[face] / a[k];
  std::array<Vec3, 4> out;
  for (int corner = 0; corner < 4; ++corner) {
    Vec3 leaned = direction;
    leaned[i] += corner & 1 ? lean_i : -lean_i;
    leaned[k] += corner & 2 ? lean_k : -lean_k;
    out[static_cast<std::size_t>(corner)] = leaned.normalized();
  }
  return out;
}

std::array<Vec3, 4> corner_directions(const HyperEllipsoid& shape, const Vec3& direction) {
  int face = 0;
  direction.cwiseAbs().maxCoeff(&face);
  return corner_directions(shape, direction, lean_of_corners(shape, face));
}

bool corners_carry(const HyperEllipsoid& shape, const Vec3& direction) {
  int face = 0;
  direction.cwiseAbs().maxCoeff(&face);
  const Vec3 flat = Vec3::Unit(face);
  return shape.semi_axes[face] - support_point(shape, corner_directions(shape, flat)[0])[face] < kNoDeeper;
}

void contacts_with_plane(const HyperEllipsoid& shape, const Pose& X_WA, const Vec3& normal, double offset, double margin,
                         ContactPoints& out) {
  out.clear();
  const Vec3 down_A = X_WA.q.conjugate() * -normal;
  auto touch_along = [&](const Vec3& direction_A, std::uint32_t key) {
    SurfaceContact c;
    c.p_a = X_WA * support_point(shape, direction_A);
    c.gap = normal.dot(c.p_a) - offset;
    c.p_b = c.p_a - c.gap * normal;
    c.normal = normal;
    c.key = key;
    return c;
  };
  const SurfaceContact deepest = touch_along(down_A, 0);
  if (deepest.gap >= margin) return;
  if (shape.exponent < kFlatExponent) {
    out.push_back(deepest);
    return;
  }
  int face = 0;
  down_A.cwiseAbs().maxCoeff(&face);
  const std::uint32_t side = static_cast<std::uint32_t>(2 * face + (down_A[face] > 0));
  double lowest = margin;
  std::uint32_t k = 0;
  for (const Vec3& direction : corner_directions(shape, down_A)) {
    const SurfaceContact c = touch_along(direction, 1 + 4 * side + k++);
    if (c.gap >= margin) continue;
    lowest = std::min(lowest, c.gap);
    out.push_back(c);
  }
  const double lifted = lowest - deepest.gap;
  if (out.empty() || lifted > kNoDeeper) {
    out.push_back(deepest);
    return;
  }
  if (!corners_carry(shape, down_A)) return;
  for (SurfaceContact& c : out) c.lifted = lifted;
}

}  // namespace engine
