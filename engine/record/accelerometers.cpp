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
  times_.push_back(0);
  for (const Person& person : world.model.persons)
    head_velocity_.push_back(person.head < 0 ? Vec3(Vec3::Zero()) : world.model.bodies[person.head].V_WB.v);
  recording.peak_acceleration.assign(world.model.bodies.size(), 0);
  for (const Body& body : world.model.bodies) velocity_.push_back(body.fixed ? Vec3(Vec3::Zero()) : body.V_WB.v);
}

void Accelerometers::follow(const World& world, const State& state, double left, Recording& recording) {
  constexpr double kSampling = 4e-5;  // [s] 25 kHz, where SAE J211 asks 10 of heads: an instant has no acceleration
  if (!yields(world.model.settings.contact_law, true) || world.model.persons.empty()) return;
  if (recording.heads.empty()) begin(world, recording);
  const double step = state.time - times_.back();
  const double spacing = std::min(kSampling, world.model.settings.step) * (1 - 1e-9);
  if (step < spacing || (left > 0 && left < spacing)) return;  // the end of the step has a sample
  for (std::size_t p = 0; p < world.model.persons.size(); ++p) {
    const int head = world.model.persons[p].head;
    if (head < 0 || state.V_WB[head].v == head_velocity_[p]) continue;  // of who waits noughts are put in once it matters
    std::vector<double>& acceleration = recording.heads[p].acceleration;
    acceleration.resize(times_.size());
    acceleration.push_back((state.V_WB[head].v - head_velocity_[p]).norm() / step);
    head_velocity_[p] = state.V_WB[head].v;
  }
  times_.push_back(state.time);
}

void Accelerometers::sample(const World& world, const State& state, Recording& recording) {
  follow(world, state, 0, recording);
  if (recording.heads.empty()) return;
  const double step = state.time - stepped_;
  stepped_ = state.time;
  const auto note_peak = [&](std::size_t b) {
    recording.peak_acceleration[b] = std::max(recording.peak_acceleration[b], (state.V_WB[b].v - velocity_[b]).norm() / step);
    velocity_[b] = state.V_WB[b].v;
  };
  if (listed_ == world.still.changes) {
    for (const int b : world.still.others) note_peak(static_cast<std::size_t>(b));
  } else {  // of who has just come to be still the last step is noted
    listed_ = world.still.changes;
    for (std::size_t b = 0; b < velocity_.size(); ++b) note_peak(b);
  }
}

void Accelerometers::finish(const World& world, Recording& recording) const {
  for (HeadMotion& head : recording.heads) {
    if (world.model.persons[head.person].head < 0) continue;
    head.time = times_;
    head.acceleration.resize(times_.size());
  }
}

}  // namespace engine
