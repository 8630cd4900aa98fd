// The step on one page. An attempt that leaves too much at its end (surfaces too deep in each other, energy out of nothing,
// impulses unsolved) is taken again, shorter; what lives for one attempt is a StepContext.
#include "engine/step/step.h"

#include <algorithm>

#include "engine/contact/mean_friction.h"
#include "engine/divergence.h"
#include "engine/effects/effect.h"
#include "engine/step/bounds.h"
#include "engine/step/energy_ledger.h"
#include "engine/step/find_contacts.h"
#include "engine/step/formulation.h"
#include "engine/step/joint_friction.h"
#include "engine/step/solve.h"
#include "engine/step/step_control.h"

namespace engine {

Stepper::Stepper(World& world, OnImpulses on_impulses)
    : world_(world),
      on_impulses_(std::move(on_impulses)),
      buffers_(world),
      motion_(world, buffers_),
      friction_varies_(friction_varies(world.model)) {}

double Stepper::advance(State& state, double most) {
  buffers_.dissipated_before = state.energy.dissipated;
  choose_trees(world_, state);
  StepControl control(world_, state, most);
  call(world_, Hook::before_step, &Effect::before_step, world_, state, control.length());
  choose_trees(world_, state);
  find_contacts_at_start(state);
  control.follow_blows_on_heads();

  std::optional<StepContext> step;
  step.emplace(world_, state, buffers_, control.length());
  if (exchange_impacts(*step, on_impulses_))
    for (Constraint& c : step->constraints) c.u.before = row_velocity(c, state.V_WB);

  Verdict verdict = attempt(state, control, step);
  while (verdict.kind == Verdict::Kind::again || verdict.kind == Verdict::Kind::place) {
    if (verdict.kind == Verdict::Kind::again) {
      ++world_.log.diagnostics.substeps;
      state.pace.next = verdict.length;
    }
    step.emplace(world_, state, buffers_, verdict.length);
    verdict = attempt(state, control, step);
  }
  state.pace.swing = motion_.swing;
  if (verdict.kind == Verdict::Kind::ended) return verdict.length;
  control.accept(*step);
  commit(*step, control.crossed() ? &motion_.crossing : nullptr);
  return step->length;
}

/// Contacts of the step before serve this one, where the same trees take part.
void Stepper::find_contacts_at_start(State& state) {
  FoundContacts& contacts = state.contacts;
  if (contacts.known && contacts.trees == world_.active_trees) return;
  buffers_.end_contacts.swap(contacts.list);  // what was found last is asked for while the list is written
  find_contacts(world_, state, state, buffers_.end_contacts, contacts.list);
  if (state.time > 0) return;
  for (const Constraint& c : contacts.list)
    if (is_contact(c) && !is_compliant(c)) warn_of_overlap(world_, c.a.record, c.b.record, c.gap);
}

Verdict Stepper::attempt(State& state, StepControl& control, std::optional<StepContext>& step) {
  // how long: to the next impact, and no longer than springs bear
  double length = control.cut_at_impact(*step);
  if (length != step->length) step.emplace(world_, state, buffers_, length);
  if (motion_.compliant) {
    motion_.compliant->begin(state, world_.model.settings.locate_events);
    if (const Verdict v = control.bear_springs(*motion_.compliant, length); v.kind != Verdict::Kind::go_on) return v;
  }

  // the smooth motion: RK4 through the joints, to the next event of a compliant contact
  motion_.note_touched(*step);
  const double error = motion_.advance(state, length);
  if (const Verdict v = control.judge_motion(motion_.swing, error, length); v.kind != Verdict::Kind::go_on) return v;
  if (motion_.compliant && control.locates_events() && motion_.locate_contact_event(state, length)) control.note_event();
  if (length != step->length) step.emplace(world_, state, buffers_, length);

  // joint resistance and the impulses of all conditions; joints closed
  step->placing = control.placing();
  if (friction_varies_) take_mean_friction(*step);
  prepare_resistance(*step);
  exchange_over_step(*step);
  note_pull(*step);
  close_joints(*step);

  // contacts at the end show what the step was blind to
  if (lost_body(world_, step->end) < 0) find_contacts(world_, state, step->end, state.contacts.list, buffers_.end_contacts);
  return control.judge_end(*step);
}

/// The end of the step becomes the state.
void Stepper::commit(StepContext& s, const CompliantContacts::Crossing* crossing) {
  State& state = s.state;
  Diagnostics& diagnostics = world_.log.diagnostics;
  if (s.impulses) {
    diagnostics.max_solver_residual = std::max(diagnostics.max_solver_residual, s.residual);
    if (s.unsettled >= 0) world_.log.unsettled.note(s.residual, s.end.time, s.constraints[s.unsettled]);
    keep_impulses(s);
    book(s);
  } else {
    state.warm.clear();
  }
  if (motion_.compliant) motion_.compliant->finish(s.end, crossing, s.constraints);
  if (on_impulses_ && !s.constraints.empty()) on_impulses_(s.constraints, s.end.time, s.length);
  diagnostics.max_joint_gap = std::max(diagnostics.max_joint_gap, s.joint_gap);
  for_awake_bodies(world_, [&](int b) {
    state.X_WB[b] = s.end.X_WB[b];
    state.V_WB[b] = s.end.V_WB[b];
  });
  state.time = s.end.time;
  state.contacts.list.swap(buffers_.end_contacts);
  state.contacts.trees = world_.active_trees;
  state.contacts.known = true;
  call(world_, Hook::after_step, &Effect::after_step, s);
  note_gains(s);
  world_.impulse.take_over(world_.smooth);  // joints were closed with factors at the end of the step
}

}  // namespace engine
