// The skin of a figure of three parts: closed, turned outward, near its segments, and moving with them.
#include "render/surface/skin.h"

#include <gmock/gmock.h>

#include <cmath>
#include <map>

namespace render {
namespace {

/// Trunk, a limb at its side, another below: upright, as figures are written; by names that have no anatomy of their own.
PersonActor figure() {
  PersonActor p;
  p.look = PersonLook::skin;
  auto segment = [&](const char* name, int parent, const Vec3& joint_P, const Vec3& axes, const Vec3& centre, float red) {
    PersonActor::Segment s;
    s.name = name;
    s.parent = parent;
    s.joint_P = joint_P;
    s.shape = {axes, 2.5};
    s.X_WB.p = centre;
    s.material.colour = {red, 0.1f, 0.1f};
    p.segments.push_back(s);
  };
  segment("trunk", -1, Vec3::Zero(), {0.11, 0.16, 0.25}, {0, 0, 1.25}, 0.5f);
  segment("limb", 0, {0, 0.18, 0.17}, {0.05, 0.05, 0.155}, {0, 0.2, 1.3}, 0.5f);
  segment("far_limb", 1, {0, 0, -0.13}, {0.04, 0.04, 0.2}, {0, 0.2, 0.99}, 0.9f);
  return p;
}

std::vector<Pose> poses(const PersonActor& p) {
  std::vector<Pose> out;
  for (const auto& s : p.segments) out.push_back(s.X_WB);
  return out;
}

Vec3 vertex(const std::vector<float>& positions, std::size_t v) {
  return {positions[3 * v], positions[3 * v + 1], positions[3 * v + 2]};
}

double volume(const std::vector<float>& positions, const std::vector<std::uint32_t>& indices) {
  double sum = 0;
  for (std::size_t t = 0; t < indices.size(); t += 3)
    sum += vertex(positions, indices[t]).dot(vertex(positions, indices[t + 1]).cross(vertex(positions, indices[t + 2]))) / 6;
  return sum;
}

void expect_closed(const Skin& skin) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
  const auto& indices = skin.mesh->indices;
  for (std::size_t t = 0; t < indices.size(); t += 3)
    for (std::size_t k = 0; k < 3; ++k) ++edges[{indices[t + k], indices[t + (k + 1) % 3]}];
  for (const auto& [edge, count] : edges) {
    ASSERT_EQ(count, 1);
    ASSERT_EQ(edges.count({edge.second, edge.first}), 1u);
  }
  EXPECT_GT(volume(skin.mesh->positions, indices), 0) << "turned outward";
}

TEST(Skin, IsClosedAndOfOneWinding) {
  const auto skin = build_skin(figure());
  expect_closed(*skin);
  EXPECT_EQ(skin->mesh->parts.size(), 2u) << "one part a colour";
}

TEST(Skin, OfAFaceIsClosedAndFineEnoughForLips) {
  PersonActor person = figure();
  PersonActor::Segment head = person.segments[0];
  head.name = "head";
  head.parent = 0;
  head.joint_P = {0, 0, 0.25};
  head.shape = {{0.0975, 0.0775, 0.120}, 2.2};
  head.X_WB.p = {0, 0, 1.62};
  head.material.kind = MaterialKind::skin;
  person.segments.push_back(head);
  const auto skin = build_skin(person);
  expect_closed(*skin);
  const auto& indices = skin->mesh->indices;
  double longest = 0;
  for (std::size_t t = 0; t < indices.size(); t += 3)
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3 a = vertex(skin->mesh->positions, indices[t + k]), b = vertex(skin->mesh->positions, indices[t + (k + 1) % 3]);
      const Vec3 middle = skin->X_SM.back() * Vec3((a + b) / 2);
      if (middle.x() > 0.08 && std::abs(middle.z()) < 0.08) longest = std::max(longest, (a - b).norm());
    }
  // a cell of the grid is 8 mm here and its diagonal 14 mm: quartered, with as much again for the slopes of nose and sockets
  EXPECT_GT(longest, 0);
  EXPECT_LT(longest, 0.007);
}

TEST(Skin, LiesOnItsSegmentsAwayFromTheJoints) {
  const PersonActor person = figure();
  const auto skin = build_skin(person);
  std::vector<float> positions, normals;
  bend_skin(*skin, poses(person), positions, normals);
  int alone = 0;
  for (std::size_t v = 0; v < skin->weights.size(); ++v) {
    const auto& w = skin->weights[v];
    ASSERT_NEAR(w[0].share + w[1].share + w[2].share + w[3].share, 1, 1e-5);
    if (w[0].segment != 2 || w[0].share < 1) continue;
    const Vec3 x_B = person.segments[2].X_WB.inverse() * vertex(positions, v);
    // the far end of the forearm: no fillet reaches it, so Newton steps onto the surface leave no more than the
    // floats and the numerical gradient do
    if (x_B.z() > 0) continue;
    ++alone;
    ASSERT_NEAR(engine::gauge(person.segments[2].shape, x_B), 1, 1e-3);
  }
  EXPECT_GT(alone, 100);
}

TEST(Skin, MovesAsOneBodyWhenItsSegmentsDo) {
  const PersonActor person = figure();
  const auto skin = build_skin(person);
  std::vector<float> before, after, normals;
  std::vector<Pose> X = poses(person);
  bend_skin(*skin, X, before, normals);
  const Pose motion{{3, -2, 0.5}, engine::Quat(Eigen::AngleAxisd(2.1, Vec3(1, 2, -1).normalized()))};
  for (Pose& p : X) p = motion * p;
  // the same rotation written as the other quaternion must not matter
  X[1].q.coeffs() *= -1;
  bend_skin(*skin, X, after, normals);
  // floats of metres: 2e-7 a coordinate
  for (std::size_t v = 0; v < skin->weights.size(); ++v) ASSERT_LT((motion * vertex(before, v) - vertex(after, v)).norm(), 2e-6);
}

TEST(Skin, KeepsItsGirthWhenAJointBends) {
  const PersonActor person = figure();
  const auto skin = build_skin(person);
  std::vector<float> straight, bent, normals;
  std::vector<Pose> X = poses(person);
  bend_skin(*skin, X, straight, normals);
  // the elbow by 100 degrees about its own place
  const Vec3 elbow = X[1] * person.segments[2].joint_P;
  const engine::Quat turn(Eigen::AngleAxisd(-1.75, Vec3::UnitY()));
  X[2] = Pose{elbow + turn * (X[2].p - elbow), turn * X[2].q};
  bend_skin(*skin, X, bent, normals);
  const auto& indices = skin->mesh->indices;
  const double change = volume(bent, indices) / volume(straight, indices) - 1;
  // the forearm is 6 % of the figure and a few per cent of that lie at the elbow; a collapsed joint loses a third of those
  EXPECT_LT(std::abs(change), 0.005);
}

}  // namespace
}  // namespace render
