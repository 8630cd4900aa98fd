#include "engine/effects/static_loads.h"

#include <Eigen/QR>
#include <algorithm>
#include <map>

#include "engine/effects/driver.h"
#include "engine/joints/joint_type.h"

namespace engine {
namespace {

constexpr double kFree = 1e3;  // [-] weight of what a stiff joint carries against a wheel's load: it costs nothing

struct Unknown {
  int body_up = -1, body_down = -1;  // pushed up, pushed down
  Eigen::Vector3d wrench;            // Fz, Mx, My about the tree's first body for one unit
  double weight = 1;
};

/// One unit of vertical force at a point.
Eigen::Vector3d push_at(const Vec3& p) {
  return {1, p.y(), -p.x()};
}

/// Does a wheel stand square on the terrain, as a vehicle does that is put on a slope?
bool stands_on(const Ground& ground, const Pose& X_WB, const Wheel& wheel) {
  constexpr double kNear = 0.03, kSquare = 0.995;  // [m], cosine
  const Vec3 up = X_WB.q * Vec3::UnitZ(), top = X_WB * wheel.hub_B + wheel.radius * up;
  double s = 0;
  int triangle = -1;
  return ground.terrain && ground.terrain->raycast(top, -up, 2 * wheel.radius + kNear, s, triangle) &&
         std::abs(s - 2 * wheel.radius) < kNear && ground.terrain->face_normals()[triangle].dot(up) > kSquare;
}

/// World axes for the balance of a tree: those of its first vehicle if all its wheels stand square on sloping terrain, so that the
/// springs carry the slope's loads from the start.
Quat axes_of(const Model& model, const Topology& topology, int tree) {
  const Vehicle* first = nullptr;
  for (const Vehicle& vehicle : model.vehicles) {
    if (topology.tree_of_body[vehicle.body] != tree) continue;
    if (!first) first = &vehicle;
    for (const Wheel& wheel : vehicle.wheels)
      if (!stands_on(model.ground, model.bodies[vehicle.body].X_WB, wheel)) return Quat::Identity();
  }
  return first ? model.bodies[first->body].X_WB.q : Quat::Identity();
}

/// A tree's bodies at rest, seen from its first body in axes in which the ground under them is level.
struct Standing {
  std::vector<Pose> X;  // per body of the model
  Vec3 gravity;
};

Standing stand(const Model& model, const Topology& topology, int tree) {
  const Pose turn{Vec3::Zero(), axes_of(model, topology, tree).conjugate()};
  Standing out{{}, turn.q * model.settings.gravity};
  const Vec3 from = model.bodies[topology.links[topology.trees[tree].begin].body].X_WB.p;
  for (const Body& body : model.bodies) out.X.push_back(turn * Pose{body.X_WB.p - from, body.X_WB.q});
  return out;
}

/// Mean height of the places where a tree's wheels stand: it has some.
double ground_under(const Model& model, const Standing& standing, const Topology& topology, int tree) {
  double sum = 0;
  int count = 0;
  for (const Vehicle& vehicle : model.vehicles)
    for (const Wheel& wheel : vehicle.wheels) {
      if (topology.tree_of_body[vehicle.body] != tree) continue;
      sum += (standing.X[vehicle.body] * wheel.hub_B).z() - wheel.radius;
      ++count;
    }
  return sum / count;
}

/// Gravity as a tree feels it that stands or rolls: on a slope its brakes hold it from the start, or it gathers speed along its
/// heading and what pulls it that way moves no load.
Vec3 felt_gravity(const Model& model, const Standing& standing, const Topology& topology, int tree) {
  const Vec3 g = standing.gravity;
  Vec3 heading = Vec3::Zero();
  double mass = 0, brakes = 0;
  for (std::size_t b = 0; b < model.bodies.size(); ++b)
    if (topology.tree_of_body[b] == tree && !model.bodies[b].fixed) mass += model.bodies[b].mass;
  for (const Vehicle& vehicle : model.vehicles) {
    if (topology.tree_of_body[vehicle.body] != tree) continue;
    if (heading.isZero()) heading = (standing.X[vehicle.body].q * Vec3::UnitX()).cwiseProduct(Vec3(1, 1, 0));
    const int wheels = static_cast<int>(vehicle.wheels.size());
    for (int w = 0; w < wheels; ++w) brakes += brake_of(vehicle, w, 0, 1.0 / wheels);
  }
  if (heading.norm() < 1e-6) return g;
  heading.normalize();
  const double pull = g.dot(heading);
  return brakes >= std::abs(mass * pull) ? g : Vec3(g - pull * heading);
}

/// What wheels must give against a force at p, tangential forces acting at the height of the ground.
Eigen::Vector3d needed(const Vec3& force, const Vec3& p, double ground) {
  const double z = p.z() - ground;
  return -Eigen::Vector3d(force.z(), p.y() * force.z() - z * force.y(), z * force.x() - p.x() * force.z());
}

}  // namespace

std::vector<double> static_wheel_loads(const Model& model, const Topology& topology) {
  std::size_t wheels = 0;
  for (const Vehicle& vehicle : model.vehicles) wheels += vehicle.wheels.size();
  std::vector<double> loads(wheels, 0);
  for (int tree = 0; tree < static_cast<int>(topology.trees.size()); ++tree) {
    std::vector<Unknown> unknowns;
    std::vector<std::size_t> wheel_of;
    std::size_t number = 0;
    const Standing standing = stand(model, topology, tree);
    for (const Vehicle& vehicle : model.vehicles)
      for (const Wheel& wheel : vehicle.wheels) {
        const std::size_t w = number++;
        if (topology.tree_of_body[vehicle.body] != tree) continue;
        unknowns.push_back({vehicle.body, -1, push_at(standing.X[vehicle.body] * wheel.hub_B), 1});
        wheel_of.push_back(w);
      }
    if (unknowns.empty()) continue;
    for (const Joint& joint : model.joints) {
      if (topology.tree_of_body[joint.child] != tree || joint.parent < 0 || topology.tree_of_body[joint.parent] != tree) continue;
      const bool ball =
          type_of(joint.kind).turns() == 3 && model.bodies[joint.child].vehicle >= 0 && model.bodies[joint.parent].vehicle >= 0;
      unknowns.push_back({joint.child, joint.parent, push_at(standing.X[joint.child] * joint.X_CF.p), ball ? 1 : kFree});
      if (ball) continue;
      unknowns.push_back({joint.child, joint.parent, {0, 1, 0}, kFree});
      unknowns.push_back({joint.child, joint.parent, {0, 0, 1}, kFree});
    }
    std::map<int, int> row;
    const auto& range = topology.trees[tree];
    for (int l = range.begin; l < range.end; ++l) row.emplace(topology.links[l].body, 3 * (l - range.begin));
    Eigen::MatrixXd A = Eigen::MatrixXd::Zero(3 * (range.end - range.begin), static_cast<Eigen::Index>(unknowns.size()));
    Eigen::VectorXd b = Eigen::VectorXd::Zero(A.rows());
    const Vec3 g = felt_gravity(model, standing, topology, tree);
    const double ground = ground_under(model, standing, topology, tree);
    for (const auto& [body, first] : row) b.segment<3>(first) = needed(model.bodies[body].mass * g, standing.X[body].p, ground);
    for (Eigen::Index k = 0; k < A.cols(); ++k) {
      const Unknown& u = unknowns[static_cast<std::size_t>(k)];
      A.block<3, 1>(row.at(u.body_up), k) += u.weight * u.wrench;
      if (u.body_down >= 0) A.block<3, 1>(row.at(u.body_down), k) -= u.weight * u.wrench;
    }
    Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> solver;
    solver.setThreshold(1e-9);
    solver.compute(A);
    const Eigen::VectorXd x = solver.solve(b);
    double total = 0;
    for (std::size_t k = 0; k < wheel_of.size(); ++k) total += x[static_cast<Eigen::Index>(k)];
    for (std::size_t k = 0; k < wheel_of.size(); ++k)
      loads[wheel_of[k]] = std::max(x[static_cast<Eigen::Index>(k)], 0.01 * total / static_cast<double>(wheel_of.size()));
  }
  return loads;
}

}  // namespace engine
