// The unrolled vehicle of the contact map, against a car of flat panels whose tape is known.
#include "render/figures/unrolled.h"

#include <gtest/gtest.h>

#include <cmath>

namespace render {
namespace {

/// Front, bonnet, windscreen, roof: panels from side to side through these points (x, z).
Stage wedge() {
  const Point2 section[] = {{2, 0.3}, {2, 0.8}, {1, 0.8}, {0.5, 1.3}, {-1, 1.3}};
  auto mesh = std::make_shared<Mesh>();
  for (const Point2& p : section)
    for (const float y : {-0.8f, 0.8f})
      mesh->positions.insert(mesh->positions.end(), {static_cast<float>(p.x()), y, static_cast<float>(p.y())});
  for (std::uint32_t panel = 0; panel < 4; ++panel) {
    const std::uint32_t a = 2 * panel;
    mesh->parts.push_back({static_cast<std::uint32_t>(mesh->indices.size()), 6, panel == 2 ? 1 : 0});
    for (const std::uint32_t i : {0u, 1u, 3u, 0u, 3u, 2u}) mesh->indices.push_back(a + i);
  }
  mesh->materials.resize(2);
  mesh->materials[0].kind = MaterialKind::paint;
  mesh->materials[1].kind = MaterialKind::glass;
  Stage stage;
  MeshActor actor;
  actor.body = 0;
  actor.mesh = mesh;
  stage.meshes.push_back(actor);
  return stage;
}

TEST(Unrolled, TapeRunsTautFromTheGroundOverTheFrontToTheEndOfTheRoof) {
  const std::vector<Point2> tape = tape_of(wedge(), 0, 0);
  double length = 0;
  for (std::size_t i = 1; i < tape.size(); ++i) length += (tape[i] - tape[i - 1]).norm();
  // straight up, over the bonnet's end without touching it to the windscreen's top, along the roof
  EXPECT_NEAR(length, 0.8 + std::hypot(1.5, 0.5) + 1.5, 1e-6);
  EXPECT_NEAR(on_tape(tape, {2, 0.5}).along, 0.5, 1e-6);
  EXPECT_NEAR(on_tape(tape, {1, 0.8}).along, 0.8 + 1.5 / std::hypot(1.5, 0.5), 1e-6);
  EXPECT_TRUE(tape_of(wedge(), 1, 0).empty()) << "another body";
}

TEST(Unrolled, TouchesOfTheUndersideAndTheWheelsAreNotOnTheTape) {
  engine::ContactRecord touch;
  touch.shapes = {engine::ShapeKind::round, engine::ShapeKind::mesh};
  // somebody under the vehicle would stand on the windscreen above
  for (const auto& [normal, above] : {std::pair(Vec3(0, 0, 1), true),
                                      {Vec3(1, 0, 0), true},
                                      {Vec3(0, 1, 0), true},
                                      {Vec3(0, 0, -1), false},
                                      {Vec3(0.29, 0, -0.957), false}}) {
    touch.normal = normal;
    EXPECT_EQ(lies_above(touch, Pose{}, 0.5), above) << normal.transpose();
  }
  EXPECT_TRUE(lies_above(touch, Pose{}, 0.1)) << "the lower edge of a bumper is of the front";
  Pose turned_over;
  turned_over.q = engine::Quat(Eigen::AngleAxisd(M_PI, Vec3::UnitX()));
  touch.normal = Vec3(0, 0, 1);
  EXPECT_FALSE(lies_above(touch, turned_over, 0.5)) << "who falls on the floor of an overturned car";
  touch.shapes.b = engine::ShapeKind::tyre;
  EXPECT_FALSE(lies_above(touch, Pose{}, 0.5));
}

TEST(Unrolled, ShowsEachPanelWhereTheTapeMeetsIt) {
  const Stage stage = wedge();
  const std::vector<Point2> tape = tape_of(stage, 0, 0);
  const UnrolledPicture picture = unroll(stage, 0, tape, 4, 1);
  const auto at = [&](double along, double across) {
    return picture.at(static_cast<int>(along / UnrolledPicture::kCell), static_cast<int>((across + 1) / UnrolledPicture::kCell));
  };
  EXPECT_EQ(at(0.1, 0), UnrolledPicture::nothing) << "below the front";
  EXPECT_EQ(at(0.5, 0), UnrolledPicture::body);
  EXPECT_EQ(at(1.5, 0.7), UnrolledPicture::body);
  EXPECT_EQ(at(2.0, -0.7), UnrolledPicture::glass);
  EXPECT_EQ(at(3.0, 0), UnrolledPicture::body);
  EXPECT_EQ(at(2.0, 0.9), UnrolledPicture::nothing) << "beside it";

  const std::vector<Stretch> named = stretches(picture, tape);
  ASSERT_EQ(named.size(), 4u);
  EXPECT_STREQ(named[2].name, "windscreen");
  const double foot = 0.8 + 1.5 / std::hypot(1.5, 0.5), top = 0.8 + std::hypot(1.5, 0.5);
  EXPECT_NEAR(named[2].from, foot, 1.01 * UnrolledPicture::kCell);
  EXPECT_NEAR(named[2].to, top, 1.01 * UnrolledPicture::kCell);
  EXPECT_NEAR(named[1].from, 0.8, 1e-6);
}

}  // namespace
}  // namespace render
