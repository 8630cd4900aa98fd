#include "engine/step/find_contacts.h"

#include "engine/divergence.h"
#include "engine/effects/effect.h"
#include "engine/step/bounds.h"

namespace engine {

void find_contacts(World& world, State& state, const Motion& at, const std::vector<Constraint>& before,
                   std::vector<Constraint>& found) {
  const bool in_stages = contacts_in_stages(world.model.settings);  // those look for themselves
  found.clear();
  ContactSearch search{{world, state, at, world.model.settings.step}, before, found};
  if (!in_stages) world.pairs.look(search);
  for (std::size_t e = 0; e < world.effects.size(); ++e) {
    const EffectKind& kind = *world.plan.active[e];
    const bool contacts = kind.takes_part(Hook::find_contacts) && !in_stages, limits = kind.takes_part(Hook::find_limits);
    if (!contacts && !limits) continue;
    const Meter::Span span(world.meter, e);
    const std::size_t first = found.size();
    if (contacts) world.effects[e]->find_contacts(search);
    if (limits) world.effects[e]->find_limits(search);
    if (found.size() > first) world.log.note_reach(static_cast<int>(e), at.time);
  }
}

void find_stage_contacts(World& world, State& state, const Motion& at, double within, std::vector<Constraint>& found) {
  found.clear();
  if (lost_body(world, at) >= 0) return;  // the end of its step will tell
  ContactSearch search{{world, state, at, within}, state.contacts.list, found};
  world.pairs.look(search);
  call(world, Hook::find_contacts, &Effect::find_contacts, search);
}

}  // namespace engine
