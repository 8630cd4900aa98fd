#include "engine/effects/driver.h"

#include <algorithm>
#include <cmath>

namespace engine {

double brake_of(const Vehicle& vehicle, int wheel, double t) {
  const double own = vehicle.wheels[wheel].brake_share;
  double force = std::clamp(vehicle.brake.at(t), 0.0, 1.0) * vehicle.brake_force * own;
  for (const DriverPhase& phase : vehicle.sequence)
    if (!phase.drives) force += phase.level_at(t) * phase.force * (phase.share.empty() ? own : phase.share[wheel]);
  return force;
}

double drive_of(const Vehicle& vehicle, int wheel, double t) {
  const auto driven = std::count_if(vehicle.wheels.begin(), vehicle.wheels.end(), [](const Wheel& w) { return w.driven; });
  const double own = vehicle.wheels[wheel].driven ? 1 / static_cast<double>(driven) : 0;
  double force = vehicle.drive_force.at(t) * own;
  for (const DriverPhase& phase : vehicle.sequence)
    if (phase.drives) force += phase.level_at(t) * phase.force * (phase.share.empty() ? own : phase.share[wheel]);
  return force;
}

void steer_along_path(World& world, const State& state, int v) {
  const Vehicle& vehicle = world.model.vehicles[v];
  const std::vector<Vec3>& path = vehicle.path.points;
  if (path.size() < 2) return;
  const Pose& X = state.X_WB[vehicle.body];
  double front = 0, rear = 0, count_front = 0, count_rear = 0;
  for (const Wheel& wheel : vehicle.wheels) {
    (wheel.steered ? front : rear) += wheel.hub_B.x();
    (wheel.steered ? count_front : count_rear) += 1;
  }
  if (count_front == 0 || count_rear == 0) return;
  const double wheelbase = front / count_front - rear / count_rear;
  const Vec3 at = X * Vec3(rear / count_rear, 0, 0);
  // nearest point of the path, then the preview along it
  double best = 1e300, share = 0;
  std::size_t segment = 0;
  for (std::size_t i = 0; i + 1 < path.size(); ++i) {
    const Vec3 d = (path[i + 1] - path[i]).cwiseProduct(Vec3(1, 1, 0));
    const bool last = i + 2 == path.size();
    const Vec3 from = (at - path[i]).cwiseProduct(Vec3(1, 1, 0));
    const double s = std::clamp(from.dot(d) / d.squaredNorm(), 0.0, last ? 1e9 : 1.0);
    const double distance = (from - s * d).norm();
    if (distance < best) best = distance, segment = i, share = s;
  }
  const double ahead = std::max(2.0, vehicle.path.preview * state.V_WB[vehicle.body].v.norm());
  double left = ahead;
  for (;; ++segment, share = 0) {
    const double length = (path[segment + 1] - path[segment]).head<2>().norm();
    if (segment + 2 == path.size() || left <= (1 - share) * length) {
      share += left / length;
      break;
    }
    left -= (1 - share) * length;
  }
  const Vec3 goal_B = X.q.conjugate() * Vec3(path[segment] + share * (path[segment + 1] - path[segment]) - at);
  const double wanted = std::atan2(2 * wheelbase * goal_B.y(), goal_B.head<2>().squaredNorm());
  const double step = vehicle.path.rate * world.step;
  double& steer = world.path_steer[v];
  steer = std::clamp(std::clamp(wanted, steer - step, steer + step), -vehicle.path.largest, vehicle.path.largest);
}

}  // namespace engine
