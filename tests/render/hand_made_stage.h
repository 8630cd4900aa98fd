// A stage and a run made by hand, for what is drawn by numbers.
#pragma once

#include <cmath>

#include "render/matrix.h"
#include "render/stage.h"

namespace render {

/// A body that runs along x at 2 m/s for a second, turned by 90 degrees to the left; one touch at 0.5 s.
inline engine::Recording made_run() {
  engine::Recording r;
  r.body_names = {"car", "ann/hips", "ann/head"};
  r.interval = 0.1;
  for (int i = 0; i <= 10; ++i) {
    engine::Snapshot s;
    s.time = 0.1 * i;
    s.bodies.own().resize(3);
    s.bodies.own()[0].X_WB.p = Vec3(2 * s.time, 0, 1);
    s.bodies.own()[0].X_WB.q = engine::Quat(Eigen::AngleAxisd(M_PI / 2, Vec3::UnitZ()));
    s.bodies.own()[0].V_WB.v = Vec3(2, 0, 0);
    if (i == 5) {
      engine::ContactRecord c;
      c.shapes = {engine::ShapeKind::round, engine::ShapeKind::mesh};
      c.body_a = 1;
      c.body_b = 0;
      c.point = Vec3(1, 0.5, 1);
      c.impulse = Vec3(0, 10, 0);
      s.contacts.push_back(c);
    }
    s.energies.kinetic = 1000 - 100 * i;
    r.snapshots.push_back(s);
  }
  r.events.push_back({0.5, "first_contact", 1, 0, Vec3::Zero(), 2.0});
  return r;
}

inline Stage made_stage() {
  Stage s;
  s.title = "test";
  Camera side;
  side.name = "side";
  s.cameras.push_back(side);
  s.speeds.push_back({0, "car"});
  return s;
}

/// Where a world point falls, -1..1.
inline Vec3 in_clip(const View& view, const Vec3& p) {
  const Eigen::Vector4d c = from_gl(view.eye_to_clip) * from_gl(view.world_to_eye) * Eigen::Vector4d(p.x(), p.y(), p.z(), 1);
  return c.head<3>() / c.w();
}

/// A block to look at and to touch.
inline MeshActor block(int body, const Vec3& lower, const Vec3& upper) {
  std::vector<Vec3> corners;
  for (int k = 0; k < 8; ++k)
    corners.emplace_back(k & 1 ? upper.x() : lower.x(), k & 2 ? upper.y() : lower.y(), k & 4 ? upper.z() : lower.z());
  const std::vector<engine::Triangle> triangles{{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                                                {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  auto mesh = std::make_shared<Mesh>();
  mesh->materials.push_back({"paint", MaterialKind::paint});
  MeshActor actor;
  actor.body = body;
  actor.mesh = mesh;
  actor.solid = std::make_shared<engine::TriangleMesh>(corners, triangles);
  return actor;
}

constexpr double kFloat = 1e-5;  // matrices are handed over in single precision, lengths of some metres

}  // namespace render
