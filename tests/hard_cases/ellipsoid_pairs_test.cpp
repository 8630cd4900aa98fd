// Depth of pairs of hyper-ellipsoids where a search for it goes wrong: parallel faces, corner to corner, one within the other.
#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>
#include <random>

#include "engine/geometry/hyper_ellipsoid_pair.h"
#include "tests/hard_cases/hard_case.h"

namespace hard_cases {
namespace {

using engine::HyperEllipsoid;
using engine::Pose;
using engine::Quat;
using engine::Vec3;

struct Pair {
  HyperEllipsoid A, B;
  Pose X_A, X_B;

  /// Distance of the two tangent planes with normal n, from B to A: the depth is what its largest value over all n leaves.
  double gap(const Vec3& n) const {
    return n.dot(X_A.p - X_B.p) - support_value(A, X_A.q.conjugate() * n) - support_value(B, X_B.q.conjugate() * n);
  }
};

/// Maximum of the gap by climbing on the sphere from a direction, with a step that shrinks: needs no derivative, so it does not
/// share the weaknesses of what it judges.
double climb(const Pair& pair, Vec3 n) {
  double best = pair.gap(n);
  for (double reach = 0.2; reach > 1e-6; reach *= 0.4) {  // the gap errs by its square
    for (int move = 0; move < 30; ++move) {
      const Vec3 t1 = n.unitOrthogonal(), t2 = n.cross(t1);
      Vec3 better = n;
      for (int k = 0; k < 8; ++k) {
        const double angle = k * std::numbers::pi / 4;
        const Vec3 m = (n + reach * (std::cos(angle) * t1 + std::sin(angle) * t2)).normalized();
        if (const double g = pair.gap(m); g > best) {
          best = g;
          better = m;
        }
      }
      if (better == n) break;
      n = better;
    }
  }
  return best;
}

double reference(const Pair& pair, std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  std::vector<std::pair<double, Vec3>> starts;
  for (int k = 0; k < 400; ++k) {
    const Vec3 n = Vec3{normal(random), normal(random), normal(random)}.normalized();
    starts.emplace_back(-pair.gap(n), n);
  }
  for (int axis = 0; axis < 3; ++axis)
    for (const double sign : {1.0, -1.0})
      for (const Pose* X : {&pair.X_A, &pair.X_B}) {
        const Vec3 n = sign * (X->q * Vec3::Unit(axis));
        starts.emplace_back(-pair.gap(n), n);
      }
  std::partial_sort(starts.begin(), starts.begin() + 5, starts.end(),
                    [](const auto& a, const auto& b) { return a.first < b.first; });
  double best = -1e300;
  for (int k = 0; k < 5; ++k) best = std::max(best, climb(pair, starts[static_cast<std::size_t>(k)].second));
  return best;
}

enum class Kind { any, parallel_faces, corner_to_corner, concentric };
const char* name_of(Kind kind) {
  return kind == Kind::any              ? "any pose"
         : kind == Kind::parallel_faces ? "parallel faces"
         : kind == Kind::concentric     ? "concentric"
                                        : "corner to corner";
}

/// Drawn in braces, which are worked off in their order; that of a call's arguments is the compiler's.
Pair make(Kind kind, std::mt19937_64& random) {
  constexpr double kExponents[] = {2, 2.01, 2.5, 7.3, 15, 29.97, 30};
  std::uniform_real_distribution<double> unit(0, 1);
  std::normal_distribution<double> normal;
  auto direction = [&] { return Vec3{normal(random), normal(random), normal(random)}.normalized(); };
  auto attitude = [&] { return Quat{normal(random), normal(random), normal(random), normal(random)}.normalized(); };
  auto shape = [&] {
    return HyperEllipsoid{Vec3{0.05 + 0.2 * unit(random), 0.05 + 0.2 * unit(random), 0.05 + 0.2 * unit(random)},
                          kExponents[random() % 7]};
  };
  Pair pair{shape(), shape(), {Vec3::Zero(), attitude()}, {}};
  const double share = unit(random);
  switch (kind) {
    case Kind::any:
      pair.X_B = {(0.12 + 0.3 * share) * direction(), attitude()};
      break;
    case Kind::parallel_faces:
      pair.X_B.q = pair.X_A.q;
      pair.X_B.p = pair.X_A.q * Vec3{0.06 * unit(random), 0.06 * unit(random),
                                     pair.A.semi_axes.z() + pair.B.semi_axes.z() - 0.02 * unit(random)};
      break;
    case Kind::corner_to_corner: {
      pair.X_B.q = pair.X_A.q;
      const Vec3 corner = (pair.A.semi_axes + pair.B.semi_axes) * 0.9;
      pair.X_B.p = pair.X_A.q * (corner + 0.01 * direction());
      break;
    }
    case Kind::concentric:
      pair.X_B = {1e-3 * share * direction(), random() % 2 ? pair.X_A.q : attitude()};
      break;
  }
  return pair;
}

std::string in_words(const testing::TestParamInfo<Kind>& tried) {
  std::string name = name_of(tried.param);
  std::replace(name.begin(), name.end(), ' ', '_');
  return name;
}

class EllipsoidPairs : public testing::TestWithParam<Kind> {};
INSTANTIATE_TEST_SUITE_P(In, EllipsoidPairs,
                         testing::Values(Kind::any, Kind::parallel_faces, Kind::corner_to_corner, Kind::concentric), in_words);

TEST_P(EllipsoidPairs, HaveTheDepthOfAMultistartSearch) {
  constexpr int kPairs = 1000;
  std::mt19937_64 random(99);
  int wrong = 0;
  double worst = 0;
  for (int k = 0; k < kPairs; ++k) {
    const Pair pair = make(GetParam(), random);
    Vec3 guess = Vec3::Zero();
    const auto found = contact_of_pair(pair.A, pair.X_A, pair.B, pair.X_B, 1, guess);
    ASSERT_TRUE(found);
    const double error = reference(pair, random) - found->gap;
    worst = std::max(worst, error);
    wrong += error > 1e-6;
  }
  row("pairs of ellipsoids", name_of(GetParam()), "%d of %d deeper than a multistart search by over 1e-6 m; at most %.1e m", wrong,
      kPairs, worst);
  EXPECT_LE(wrong, kPairs / 1000);
}

/// All but concentric ones: which way is out of the middle is not continuous.
class SlidingEllipsoidPairs : public testing::TestWithParam<Kind> {};
INSTANTIATE_TEST_SUITE_P(In, SlidingEllipsoidPairs, testing::Values(Kind::any, Kind::parallel_faces, Kind::corner_to_corner),
                         in_words);

/// One part slides past another by a tenth of a millimetre a look: the normal may not jump.
TEST_P(SlidingEllipsoidPairs, HaveNormalsThatDoNotJump) {
  std::mt19937_64 random(7);
  std::normal_distribution<double> normal;
  int jumps = 0, looks = 0;
  for (int k = 0; k < 100; ++k) {
    Pair pair = make(GetParam(), random);
    const Vec3 along = Vec3{normal(random), normal(random), normal(random)}.normalized();
    Vec3 guess = Vec3::Zero(), before = Vec3::Zero();
    for (int step = 0; step < 60; ++step) {
      pair.X_B.p += 1e-4 * along;
      const auto found = contact_of_pair(pair.A, pair.X_A, pair.B, pair.X_B, 1, guess);
      ASSERT_TRUE(found);
      // two directions of equal depth change over without harm: the depth does not jump
      if (step > 0 && (found->normal - before).norm() > 0.5 && pair.gap(before) < found->gap - 1e-3) ++jumps;
      before = found->normal;
      ++looks;
    }
  }
  row("normals of pairs", name_of(GetParam()), "%d jumps in %d looks", jumps, looks);
  EXPECT_EQ(jumps, 0);
}

class DrivenEllipsoidPairs : public testing::TestWithParam<Kind> {};
INSTANTIATE_TEST_SUITE_P(In, DrivenEllipsoidPairs,
                         testing::Values(Kind::any, Kind::parallel_faces, Kind::corner_to_corner, Kind::concentric), in_words);

/// One part is driven through another by up to a millimetre and half a degree a look. What is remembered of its other normals may
/// spare a search only where the search finds nothing better: a second look from the same guess searches always.
TEST_P(DrivenEllipsoidPairs, AreSparedOnlySearchesThatFindNothing) {
  std::mt19937_64 random(11);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> unit(0, 1);
  auto direction = [&] { return Vec3{normal(random), normal(random), normal(random)}.normalized(); };
  int spared = 0, searched = 0, wrong = 0;
  double worst = 0;
  for (int k = 0; k < 100; ++k) {
    Pair pair = make(GetParam(), random);
    const double length = 1e-3 * unit(random), angle = 0.01 * unit(random);
    const Vec3 step = length * direction();
    const Quat turn(Eigen::AngleAxisd(angle, direction()));
    engine::OtherNormals others;
    Vec3 guess = Vec3::Zero();
    for (int look = 0; look < 60; ++look) {
      pair.X_B = {pair.X_B.p + step, turn * pair.X_B.q};
      Vec3 same_guess = guess;
      const Pose before = others.X_AB;
      const auto found = contact_of_pair(pair.A, pair.X_A, pair.B, pair.X_B, 1, guess, nullptr, &others);
      const auto all = contact_of_pair(pair.A, pair.X_A, pair.B, pair.X_B, 1, same_guess);
      ASSERT_TRUE(found && all);
      const double deep = -0.1 * std::min(pair.A.semi_axes.minCoeff(), pair.B.semi_axes.minCoeff());
      if (found->gap < deep) (others.X_AB.p != before.p ? searched : spared) += 1;  // nothing else is searched once it is warm
      worst = std::max(worst, all->gap - found->gap);
      wrong += all->gap > found->gap + 1e-6;
    }
  }
  row("searches spared", name_of(GetParam()), "%d of %d; %d missed something, by %.1e m at most", spared, spared + searched, wrong,
      worst);
  EXPECT_GT(spared, searched);  // 65 to 94 % are, by the kind
  EXPECT_LE(wrong, (spared + searched) / 1000);
}

}  // namespace
}  // namespace hard_cases
