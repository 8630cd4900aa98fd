// A part that slides over a flat sheet of a thousand triangles moves as over a plane: edges between them are not felt.
#include <gtest/gtest.h>

#include "tests/engine/experiment.h"

namespace {

using namespace engine;
using namespace engine::test;

/// Level, 23 x 22 squares of two triangles over 12 m x 6 m: 1,012 triangles.
std::shared_ptr<const TriangleMesh> sheet() {
  constexpr int kAlong = 23, kAcross = 22;
  std::vector<Vec3> vertices;
  std::vector<Triangle> triangles;
  for (int i = 0; i <= kAlong; ++i)
    for (int j = 0; j <= kAcross; ++j) vertices.push_back({12.0 * i / kAlong - 1, 6.0 * j / kAcross - 3, 0});
  for (int i = 0; i < kAlong; ++i)
    for (int j = 0; j < kAcross; ++j) {
      const int a = i * (kAcross + 1) + j, b = a + kAcross + 1;
      triangles.push_back({a, b, b + 1});
      triangles.push_back({a, b + 1, a + 1});
    }
  return std::make_shared<TriangleMesh>(vertices, triangles);
}

struct Slide {
  const char* name;
  HyperEllipsoid shape;
  Twist V;
  ContactLaw law;
  Scheme scheme;
};

void PrintTo(const Slide& slide, std::ostream* out) {
  *out << slide.name;
}

class Sliding : public testing::TestWithParam<Slide> {};

Recording run(const Slide& slide, bool on_sheet) {
  Model model = on_ground(1.2, 1e-3);
  model.settings.contact_law = slide.law;
  model.settings.scheme = slide.scheme;
  model.settings.record_interval = 0.01;
  model.bodies = {solid(slide.shape, 5, {0, 0.05, slide.shape.semi_axes.z()})};
  model.bodies[0].V_WB = slide.V;
  model.bodies[0].surface.friction_ground = 0.4;
  if (on_sheet) {
    model.ground.plane = false;
    model.ground.terrain = sheet();
    EXPECT_GE(model.ground.terrain->triangles().size(), 1000u);
  }
  return simulate(model);
}

TEST_P(Sliding, OverASheetKeepsTheTrajectoryOfAPlane) {
  const Recording plane = run(GetParam(), false), sheet = run(GetParam(), true);
  ASSERT_FALSE(plane.failure || sheet.failure);
  ASSERT_EQ(plane.snapshots.size(), sheet.snapshots.size());
  double worst = 0;
  for (std::size_t i = 0; i < plane.snapshots.size(); ++i) {
    const BodyState &a = plane.snapshots[i].bodies[0], &b = sheet.snapshots[i].bodies[0];
    ASSERT_LT((a.X_WB.p - b.X_WB.p).norm(), 1e-6) << plane.snapshots[i].time;
    worst = std::max(worst, a.X_WB.q.angularDistance(b.X_WB.q));
  }
  EXPECT_LT(worst, 1e-4) << "rad";
  // a dozen squares at least were crossed
  EXPECT_GT(plane.snapshots.back().bodies[0].X_WB.p.x(), 3);
}

constexpr auto kAuto = ContactLaw::default_auto;
INSTANTIATE_TEST_SUITE_P(
    Parts, Sliding,
    testing::Values(
        Slide{"head that slides and rolls", {{0.0975, 0.0775, 0.12}, 2.2}, {{6, 0.3, 0}, {0, 0, 2}}, kAuto, Scheme::stepping},
        Slide{"ball", {{0.1, 0.1, 0.1}, 2}, {{6, 0.4, 0}, {0, 0, 0}}, kAuto, Scheme::stepping},
        Slide{"torso on its back", {{0.245, 0.165, 0.115}, 3}, {{5, 0.3, 0}, {0, 0, 1}}, kAuto, Scheme::stepping},
        Slide{"foot", {{0.13, 0.046, 0.035}, 3}, {{6, 0.2, 0}, {0, 0, 1}}, kAuto, Scheme::stepping},
        Slide{"box on its face", {{0.3, 0.2, 0.1}, 30}, {{6, 0.3, 0}, {0, 0, 0.5}}, kAuto, Scheme::stepping},
        Slide{"box that turns, rk4", {{0.12, 0.17, 0.06}, 30}, {{6, 0.4, 0}, {0, 0, 6}}, kAuto, Scheme::rk4},
        Slide{"box of exponent 6", {{0.3, 0.2, 0.1}, 6}, {{6, 0.3, 0}, {0, 0, 1}}, kAuto, Scheme::stepping},
        Slide{"box, compliant", {{0.3, 0.2, 0.1}, 30}, {{6, 0.3, 0}, {0, 0, 0.5}}, ContactLaw::compliant, Scheme::rk4},
        Slide{"head, compliant", {{0.0975, 0.0775, 0.12}, 2.2}, {{6, 0.3, 0}, {0, 0, 2}}, ContactLaw::compliant, Scheme::rk4}));

}  // namespace
