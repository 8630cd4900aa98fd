#include "engine/record/accelerometers.h"

#include <algorithm>

namespace engine {

void Accelerometers::begin(const World& world, Recording& recording) {
  // one sample a step, and more where steps are divided; a run longer than this grows
  constexpr double kLeast = 4096, kMost = 1e6;
  const Settings& settings = world.model.settings;
  const auto room = static_cast<std::size_t>(std::clamp(1.2 * settings.duration / settings.step, kLeast, kMost));
  for (int p = 0; p < static_cast<int>(world.model.persons.size()); ++p) {
    recording.heads.push_back({p, {}, {}});
    recording.heads.back().acceleration.reserve(room);
  }
  times_.reserve(room);
  moving_.reserve(world.model.persons.size());
  recording.peak_acceleration.assign(world.model.bodies.size(), 0);
  for (const Body& body : world.model.bodies) velocity_.push_back(body.fixed ? Vec3(Vec3::Zero()) : body.V_WB.v);
}

void Accelerometers::list_moving(const World& world) {
  listed_ = world.still.changes;
  const std::vector<int>& others = world.still.others;
  moving_.clear();
  for (int p = 0; p < static_cast<int>(world.model.persons.size()); ++p) {
    const std::vector<int>& bodies = world.model.persons[p].bodies;
    const auto moves = [&](int b) { return std::binary_search(others.begin(), others.end(), b); };
    if (std::any_of(bodies.begin(), bodies.end(), moves)) moving_.push_back(p);
  }
}

void Accelerometers::sample(const World& world, const State& state, Recording& recording) {
  if (!yields(world.model.settings.contact_law, true) || world.model.persons.empty()) return;
  if (recording.heads.empty()) begin(world, recording);
  const double step = state.time - sampled_;
  const auto note_head = [&](int p) {
    const int head = world.model.persons[p].head;
    if (head < 0 || state.V_WB[head].v == velocity_[head]) return;  // of who waits noughts are put in once it matters
    std::vector<double>& acceleration = recording.heads[p].acceleration;
    acceleration.resize(times_.size());
    acceleration.push_back((state.V_WB[head].v - velocity_[head]).norm() / step);
  };
  const auto note_peak = [&](std::size_t b) {
    recording.peak_acceleration[b] = std::max(recording.peak_acceleration[b], (state.V_WB[b].v - velocity_[b]).norm() / step);
    velocity_[b] = state.V_WB[b].v;
  };
  if (listed_ == world.still.changes) {
    for (const int p : moving_) note_head(p);
    for (const int b : world.still.others) note_peak(static_cast<std::size_t>(b));
  } else {  // of who has just come to be still the last step is noted
    list_moving(world);
    for (int p = 0; p < static_cast<int>(world.model.persons.size()); ++p) note_head(p);
    for (std::size_t b = 0; b < velocity_.size(); ++b) note_peak(b);
  }
  times_.push_back(state.time - 0.5 * step);
  sampled_ = state.time;
}

void Accelerometers::finish(const World& world, Recording& recording) const {
  for (HeadMotion& head : recording.heads) {
    if (world.model.persons[head.person].head < 0) continue;
    head.time = times_;
    head.acceleration.resize(times_.size());
  }
}

}  // namespace engine
