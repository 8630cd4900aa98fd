#include "engine/step/joint_friction.h"

#include "engine/effects/effect.h"
#include "engine/step/smooth_motion.h"

namespace engine {
namespace {

/// How fast the joints that resist turn now.
void note_turning(StepContext& s, Vec3 Resistance::*when) {
  for (const int tree : s.world.active_trees)
    for (int l = s.world.topology.trees[tree].begin; l < s.world.topology.trees[tree].end; ++l) {
      const int j = s.world.topology.links[l].joint;
      if (j < 0 || !s.buffers.dampers[j].present) continue;
      const Joint& joint = s.world.model.joints[j];
      const Vec3 w_P = joint.parent < 0 ? Vec3(Vec3::Zero()) : s.end.V_WB[joint.parent].w;
      s.buffers.resistances[j].*when = s.end.V_WB[joint.child].w - w_P;
    }
}

}  // namespace

void prepare_resistance(StepContext& s) {
  call(s.world, Hook::resist, &Effect::resist, s);
}

void apply_resistance(StepContext& s) {
  note_turning(s, &Resistance::w_before);
  const Topology& topology = s.world.topology;
  std::vector<Vec6>&force = s.buffers.force, &result = s.buffers.result;
  for (const int tree : s.world.active_trees) {
    const Topology::Tree& range = topology.trees[tree];
    for (int l = range.begin; l < range.end; ++l) force[topology.links[l].body].setZero();
    for (int l = range.begin; l < range.end; ++l) {
      const int j = topology.links[l].joint;
      if (j < 0 || !s.buffers.dampers[j].present) continue;
      const Joint& joint = s.world.model.joints[j];
      const Resistance& resistance = s.buffers.resistances[j];
      const Vec3 twist = resistance.torque_W * s.length - s.buffers.dampers[j].matrix * resistance.w_before;
      force[joint.child].tail<3>() += twist;
      if (joint.parent >= 0) force[joint.parent].tail<3>() -= twist;
    }
    s.world.impulse.solve(topology, tree, force, result, Articulation::Bias::zero);
    for (int l = range.begin; l < range.end; ++l) {
      const int b = topology.links[l].body;
      s.end.V_WB[b].v += result[b].head<3>();
      s.end.V_WB[b].w += result[b].tail<3>();
      displace(s.end.X_WB[b], 0.5 * s.length * result[b].head<3>(), 0.5 * s.length * result[b].tail<3>());
    }
  }
}

void note_turning_after(StepContext& s) {
  note_turning(s, &Resistance::w_after);
}

bool friction_gave_way(StepContext& s) {
  bool any = false;
  for (std::size_t e = 0; e < s.world.effects.size(); ++e)
    if (s.world.plan.active[e]->takes_part(Hook::gave_way)) any = s.world.effects[e]->gave_way(s) || any;
  return any;
}

double resistance_work(const StepContext& s, int j) {
  const Resistance& resistance = s.buffers.resistances[j];
  const Vec3 twist = resistance.torque_W * s.length - s.buffers.dampers[j].matrix * resistance.w_after;
  return 0.5 * twist.dot(resistance.w_before + resistance.w_after);
}

}  // namespace engine
