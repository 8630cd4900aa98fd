#include "engine/measure/metrics.h"

namespace engine {

void measure_segments(const Model& model, const Recording& recording, int p, std::vector<Metric>& out) {
  if (recording.peak_acceleration.empty()) return;
  for (const int b : model.persons[p].bodies)
    out.push_back({"peak_acceleration_mps2", model.bodies[b].name, recording.peak_acceleration[b]});
}

}  // namespace engine
