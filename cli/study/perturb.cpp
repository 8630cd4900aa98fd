#include "cli/study/perturb.h"

#include <numeric>
#include <random>
#include <vector>

namespace cli::study {
namespace {

/// Which bodies hang together: per body the number of its cluster, -1 for what is tied to the world.
std::vector<int> clusters(const engine::Model& model) {
  std::vector<int> cluster(model.bodies.size());
  std::iota(cluster.begin(), cluster.end(), 0);
  for (std::size_t b = 0; b < model.bodies.size(); ++b)
    if (model.bodies[b].fixed) cluster[b] = -1;
  for (bool changed = true; changed;) {
    changed = false;
    for (const engine::Joint& joint : model.joints) {
      const int parent = joint.parent < 0 ? -1 : cluster[joint.parent];
      int& child = cluster[joint.child];
      if (parent == child) continue;
      changed = true;
      const int lower = std::min(parent, child);
      child = lower;
      if (joint.parent >= 0) cluster[joint.parent] = lower;
    }
  }
  return cluster;
}

/// In -1..1. Not std::uniform_real_distribution: its numbers are the library's, these are the same everywhere.
class Chance {
 public:
  explicit Chance(int seed) : bits_(static_cast<std::uint64_t>(seed)) {}
  double draw() { return static_cast<double>(bits_() >> 11) * 0x1p-52 - 1.0; }

 private:
  std::mt19937_64 bits_;
};

}  // namespace

void start_elsewhere(engine::Model& model, int draw) {
  Chance chance(draw);
  const auto shift = [&chance](engine::Vec3& p) {
    p.x() += kStartGrid * chance.draw();
    p.y() += kStartGrid * chance.draw();
  };
  for (engine::Body& body : model.bodies) shift(body.X_WB.p);
  for (engine::Joint& joint : model.joints)
    if (joint.parent < 0) shift(joint.X_PF.p);
}

void perturb(engine::Model& model, int member) {
  if (member == 0) return;
  Chance chance(member);
  const auto draw = [&chance] { return chance.draw(); };
  model.settings.gravity *= 1 + kPerturbedSpeed * draw();
  const std::vector<int> cluster = clusters(model);
  for (int c = 0; c < static_cast<int>(model.bodies.size()); ++c) {
    const double dx = kPerturbedPosition * draw();
    const double dy = kPerturbedPosition * draw();
    const double faster = 1 + kPerturbedSpeed * draw();
    for (std::size_t b = 0; b < model.bodies.size(); ++b) {
      if (cluster[b] != c) continue;
      model.bodies[b].X_WB.p += engine::Vec3(dx, dy, 0);
      model.bodies[b].V_WB.v *= faster;
      model.bodies[b].V_WB.w *= faster;
    }
  }
}

}  // namespace cli::study
