#include "engine/step/joint_friction.h"

#include <algorithm>

#include "engine/effects/effect.h"
#include "engine/step/smooth_motion.h"

namespace engine {
namespace {

/// How fast the joints that resist turn and slide now.
void note_motion(StepContext& s, Twist Resistance::*when) {
  for (const int tree : s.world.active_trees)
    for (int l = s.world.topology.trees[tree].begin; l < s.world.topology.trees[tree].end; ++l) {
      const int j = s.world.topology.links[l].joint;
      if (j < 0 || !s.buffers.dampers[j].present) continue;
      const Joint& joint = s.world.model.joints[j];
      Resistance& resistance = s.buffers.resistances[j];
      resistance.*when =
          relative_motion(resistance.at_start, joint.parent < 0 ? Twist{} : s.end.V_WB[joint.parent], s.end.V_WB[joint.child]);
    }
}

/// Angular impulse and impulse over the step on the child if the joint moved as given.
Twist impulse_at(const StepContext& s, int j, const Twist& motion) {
  const Resistance& resistance = s.buffers.resistances[j];
  const JointDamper& damper = s.buffers.dampers[j];
  Twist out;
  out.w = resistance.torque_W * s.length - damper.turning * motion.w;
  if (resistance.at_start.free[kSlide]) out.v = resistance.force_W * s.length - damper.sliding * motion.v;
  return out;
}

}  // namespace

void prepare_resistance(StepContext& s) {
  call(s.world, Hook::resist, &Effect::resist, s);
}

void apply_resistance(StepContext& s) {
  note_motion(s, &Resistance::before);
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
      const Twist impulse = impulse_at(s, j, resistance.before);
      force[joint.child].tail<3>() += impulse.w;
      if (joint.parent >= 0) force[joint.parent].tail<3>() -= impulse.w;
      if (resistance.at_start.free[kSlide]) add_along_slide(resistance.at_start, joint, impulse.v, force);
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

void note_motion_after(StepContext& s) {
  note_motion(s, &Resistance::after);
}

bool friction_gave_way(StepContext& s) {
  bool any = false;
  std::fill(s.buffers.loosened.begin(), s.buffers.loosened.end(), 0);
  for (std::size_t e = 0; e < s.world.effects.size(); ++e)
    if (s.world.plan.active[e]->takes_part(Hook::gave_way)) any = s.world.effects[e]->gave_way(s) || any;
  return any;
}

double resistance_work(const StepContext& s, int j) {
  const Resistance& resistance = s.buffers.resistances[j];
  const Joint& joint = s.world.model.joints[j];
  const Twist impulse = impulse_at(s, j, resistance.after);
  // over the way of the step: what the impulse displaces the smooth forces' potential gains or loses
  const Twist at_start =
      relative_motion(resistance.at_start, joint.parent < 0 ? Twist{} : s.state.V_WB[joint.parent], s.state.V_WB[joint.child]);
  const double turning = 0.5 * impulse.w.dot(at_start.w + resistance.after.w);
  if (!resistance.at_start.free[kSlide]) return turning;
  return turning + 0.5 * impulse.v.dot(at_start.v + resistance.after.v);
}

}  // namespace engine
