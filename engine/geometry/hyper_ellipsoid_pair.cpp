// The common normal maximises the signed gap   g(n) = n.(c_A - c_B) - h_A(n) - h_B(n)   over unit n (from B to A): where it is
// stationary the tangent planes are parallel and (c_A - c_B) - s(n) is along n, the source's (75), (76). Apart, g is concave and
// its maximum the distance; overlapping, the largest maximum is the least depth and there can be several, so the search starts from
// many directions. g at any n is a lower bound of the gap and second order in the error of n: gap and points always come from
// g at the final n.
#include "engine/geometry/hyper_ellipsoid_pair.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "engine/geometry/common_normal.h"
#include "engine/geometry/small_vector.h"
#include "engine/math/functions.h"

namespace engine {
namespace {

/// On a flat side a normal that is right to rounding still leaves open where along the side the surfaces meet: the support point
/// of the rounder of the two tells. Share of the way across from A's point to B's.
double share_across(const RoundPair& pair, const SurfaceContact& c) {
  constexpr double kSlip = 1e-6;  // [m]
  const Vec3 across = (c.p_b - c.p_a) - (c.p_b - c.p_a).dot(c.normal) * c.normal;
  if (across.norm() < kSlip) return 0.5;
  // how far a support point goes for a small turn of the normal in the direction they are apart
  const Vec3 lean = (c.normal + 1e-6 * across.normalized()).normalized();
  auto travel = [&](std::size_t s) {
    const auto& shape = *pair.shape[s];
    return (support_point(shape, pair.R_WS[s].transpose() * lean) - support_point(shape, pair.R_WS[s].transpose() * c.normal))
        .norm();
  };
  const double a = travel(0), b = travel(1);
  return a + b > 0 ? a / (a + b) : 0.5;
}

constexpr double kCoarse = 1e-4;  // [rad] far enough to tell which of several maxima is the largest
constexpr double kFine = 2e-11;   // [rad]
constexpr int kDirections = 120;  // looked along
constexpr int kFollowed = 7;      // of them

/// Directions spread evenly over the sphere.
const std::array<Vec3, kDirections>& all_round() {
  static const std::array<Vec3, kDirections> directions = [] {
    constexpr double kGoldenAngle = 2.399963;  // [rad]
    std::array<Vec3, kDirections> out;
    for (int k = 0; k < kDirections; ++k) {
      const double z = 1 - (2 * k + 1.0) / kDirections, turn = kGoldenAngle * k;
      const double r = std::sqrt(1 - z * z);
      out[static_cast<std::size_t>(k)] = {r * math::cos(turn), r * math::sin(turn), z};
    }
    return out;
  }();
  return directions;
}

/// The largest of several maxima of the gap of two bodies in each other, and the next.
class DeepSearch {
 public:
  DeepSearch(const RoundPair& pair, const CommonNormal& first, bool thorough) : pair_(pair), best_(first), thorough_(thorough) {
    found_.push_back({first.at.n, first.at.gap});
  }

  void try_from(const Vec3& n) {
    if (pair_.gap(n) < 2 * best_.at.gap - 0.5 * pair_.shape[0]->semi_axes.maxCoeff()) return;
    CommonNormal top = climb(pair_, n, 25);
    if (!same_hill(top.at.n, best_.at.n) && !close_in(pair_, top.at) && !top.stationary && thorough_)
      top = settle(pair_, top, kCoarse);
    found_.push_back({top.at.n, top.at.gap});
    if (top.at.gap > best_.at.gap + 1e-12) best_ = top;
  }

  /// Boxes deep in each other hide maxima from their axes: looks around evenly, and tries the most promising directions, each away
  /// from those tried before.
  void look_round() {
    const auto& directions = all_round();
    for (std::size_t k = 0; k < kDirections; ++k) gaps_[k] = pair_.gap(directions[k]);
    std::array<Vec3, kFollowed + 1> tried;
    tried[0] = best_.at.n;
    for (std::size_t round = 1; round <= kFollowed; ++round) {
      const auto end = tried.begin() + static_cast<std::ptrdiff_t>(round);
      std::size_t promising = kDirections;
      for (std::size_t k = 0; k < kDirections; ++k) {
        if (promising < kDirections && gaps_[k] <= gaps_[promising]) continue;
        if (std::none_of(tried.begin(), end, [&](const Vec3& t) { return near(directions[k], t); })) promising = k;
      }
      tried[round] = promising < kDirections ? directions[promising] : best_.at.n;
      try_from(tried[round]);
    }
  }

  const CommonNormal& best() const { return best_; }
  /// [m] the most of another hill, and of any direction away from the best: as they move, new hills grow out of its sides.
  double next_gap() const {
    double next = -std::numeric_limits<double>::infinity();
    for (const Tried& t : found_)
      if (!same_hill(t.n, best_.at.n)) next = std::max(next, t.gap);
    for (std::size_t k = 0; k < kDirections; ++k)
      if (!near(all_round()[k], best_.at.n)) next = std::max(next, gaps_[k]);
    return next;
  }

 private:
  static bool near(const Vec3& a, const Vec3& b) { return a.dot(b) > 0.9; }
  /// Within 0.6 deg: the same, or stalled on the way to it.
  static bool same_hill(const Vec3& a, const Vec3& b) { return a.dot(b) > 0.99995; }

  struct Tried {
    Vec3 n;
    double gap = 0;
  };
  const RoundPair& pair_;
  CommonNormal best_;
  SmallVector<Tried, kFollowed + 8> found_;
  std::array<double, kDirections> gaps_{};  // [m] of all_round()
  bool thorough_;
};

CommonNormal search_deep(const RoundPair& pair, const CommonNormal& first, const Vec3& towards, bool warm, double& next_gap) {
  DeepSearch search(pair, first, !warm);
  if (warm) search.try_from(towards);
  for (int i = 0; i < 3; ++i)
    for (const Mat3& R : pair.R_WS) search.try_from(R.col(i).dot(pair.d) < 0 ? Vec3(-R.col(i)) : Vec3(R.col(i)));
  search.look_round();
  next_gap = search.next_gap();
  return climb(pair, search.best().at.n, 60);
}

/// From the last normal, or the line of the centres.
CommonNormal nearest_top(const RoundPair& pair, RoundPair::At at, bool warm) {
  if (warm && close_in(pair, at)) return {at, true};
  const CommonNormal top = climb(pair, at.n, 40);
  return warm || top.stationary ? top : settle(pair, top, kCoarse);
}

/// `other_gap`: no other normal can have more; on return, if they were looked for, what was found.
std::optional<SurfaceContact> search(const HyperEllipsoid& A, const Pose& X_WA, const HyperEllipsoid& B, const Pose& X_WB,
                                     double margin, Vec3& normal_guess, double* apart, double& other_gap) {
  const RoundPair pair{{&A, &B}, {X_WA.q.toRotationMatrix(), X_WB.q.toRotationMatrix()}, X_WA.p - X_WB.p};
  const double distance = pair.d.norm();
  const Vec3 towards = distance > 1e-12 ? Vec3(pair.d / distance) : Vec3(Vec3::UnitZ());
  const bool warm = normal_guess.squaredNorm() > 0.5;
  // any direction that separates by more than the margin ends it
  const RoundPair::At start = pair.at(warm ? normal_guess : towards);
  if (start.gap >= margin) {
    if (apart) *apart = start.gap;
    return std::nullopt;
  }
  CommonNormal best = nearest_top(pair, start, warm);
  const bool deep = best.at.gap < -0.1 * std::min(A.semi_axes.minCoeff(), B.semi_axes.minCoeff());
  // apart, the gap is concave over directions: a maximum is the only one
  if (best.at.gap < 0 && (!warm || deep) && other_gap >= best.at.gap) best = search_deep(pair, best, towards, warm, other_gap);
  if (best.at.gap < margin) best = settle(pair, best, kFine);
  normal_guess = best.at.n;
  if (best.at.gap >= margin) {
    if (apart) *apart = best.at.gap;
    return std::nullopt;
  }
  SurfaceContact c;
  c.normal = best.at.n;
  c.gap = best.at.gap;
  c.p_a = X_WA.p - pair.R_WS[0] * best.at.reach[0].point;
  c.p_b = X_WB.p + pair.R_WS[1] * best.at.reach[1].point;
  c.share_across = share_across(pair, c);
  return c;
}

}  // namespace

double OtherNormals::by_now(const Pose& X_AB_now, double reach) const {
  // |dq| = 2 sin(angle/4), so 2 |dq| bounds the chord 2 sin(angle/2) of a point at distance one
  const auto &q = X_AB_now.q.coeffs(), &then = X_AB.q.coeffs();
  const double dq = std::sqrt(std::min((q - then).squaredNorm(), (q + then).squaredNorm()));
  return gap + (X_AB_now.p - X_AB.p).norm() + 2 * dq * reach;
}

std::optional<SurfaceContact> contact_of_pair(const HyperEllipsoid& A, const Pose& X_WA, const HyperEllipsoid& B, const Pose& X_WB,
                                              double margin, Vec3& normal_guess, double* apart, OtherNormals* others) {
  const Pose X_AB = others ? X_WA.inverse() * X_WB : Pose();
  const double other_before = others ? others->by_now(X_AB, B.semi_axes.norm()) : std::numeric_limits<double>::infinity();
  double other_gap = other_before;
  // always the same way round, so that what A gets of B is what B gets of A, to the last bit
  const Vec3 &a = X_WA.p, &b = X_WB.p;
  const bool swapped = std::lexicographical_compare(b.data(), b.data() + 3, a.data(), a.data() + 3);
  Vec3 guess = swapped ? Vec3(-normal_guess) : normal_guess;
  auto contact = swapped ? search(B, X_WB, A, X_WA, margin, guess, apart, other_gap)
                         : search(A, X_WA, B, X_WB, margin, guess, apart, other_gap);
  normal_guess = swapped ? Vec3(-guess) : guess;
  if (others && other_gap != other_before) *others = {other_gap, X_AB};
  if (contact && swapped) {
    contact->normal = -contact->normal;
    std::swap(contact->p_a, contact->p_b);
    contact->share_across = 1 - contact->share_across;
  }
  return contact;
}

}  // namespace engine
