// The car of the reference histories, for tests of vehicles on their wheels.
#pragma once

#include "engine/geometry/triangle_mesh.h"
#include "tests/engine/experiment.h"

namespace engine::test {

constexpr double kDegree = std::numbers::pi / 180;

/// The 2004 sedan of the reference histories: 3298 lb, yaw inertia 2040 slug ft^2, wheelbase 106 in, centre of mass 38.1 in behind
/// the front axle and 21.5 in high, track 60 in, overhangs 38 and 43 in, width 70 in; tyre friction 0.76.
constexpr double kInch = 0.0254, kFoot = 0.3048, kMph = 0.44704;

inline void add_reference_car(Model& model, double x, double speed) {
  Body body = inert(1495.95, {560, 2600, 2765.9}, {x, 0, 21.5 * kInch});
  body.name = "car" + std::to_string(model.vehicles.size());
  body.V_WB.v.x() = speed;
  const double front = (38.1 + 38) * kInch, rear = -(106 - 38.1 + 43) * kInch, half = 35 * kInch;
  // what meets in a rear-end collision: the bumpers, which stand 16 to 20 in above the road (49 CFR part 581), below the centre of
  // mass
  std::vector<Vec3> corners;
  for (int i = 0; i < 8; ++i)
    corners.push_back({i & 1 ? front : rear, i & 2 ? half : -half, (i & 4 ? 20 - 21.5 : 16 - 21.5) * kInch});
  const std::vector<Triangle> faces{{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                                    {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  body.shape = MeshShape{std::make_shared<TriangleMesh>(corners, faces), {}};
  body.collision_model = CollisionModel::kudlich_slibar;
  body.surface.restitution_body = 0.1;
  Vehicle vehicle;
  vehicle.name = body.name;
  vehicle.body = static_cast<int>(model.bodies.size());
  body.vehicle = static_cast<int>(model.vehicles.size());
  for (const double at : {38.1, 38.1 - 106})
    for (const double side : {30.0, -30.0}) {
      Wheel wheel;
      wheel.hub_B = Vec3(at * kInch, side * kInch, -(21.5 * kInch - 0.31));
      wheel.radius = 0.31;
      wheel.friction = 0.76;
      wheel.steered = at > 0;
      wheel.driven = at > 0;
      wheel.brake_share = at > 0 ? 0.35 : 0.15;
      vehicle.wheels.push_back(wheel);
    }
  model.vehicles.push_back(vehicle);
  model.bodies.push_back(body);
}

}  // namespace engine::test
