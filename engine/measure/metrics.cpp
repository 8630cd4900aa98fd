#include "engine/measure/metrics.h"

namespace engine {

std::vector<Metric> measure(const Model& model, const Recording& recording) {
  std::vector<Metric> out;
  for (int p = 0; p < static_cast<int>(model.persons.size()); ++p) {
    measure_throw(model, recording, p, out);
    measure_head(model, recording, p, out);
    measure_segments(model, recording, p, out);
  }
  for (int b = 0; b < static_cast<int>(model.bodies.size()); ++b)
    if (model.bodies[b].person < 0 && model.bodies[b].vehicle < 0 && !model.bodies[b].fixed) measure_body(model, recording, b, out);
  for (int v = 0; v < static_cast<int>(model.vehicles.size()); ++v) measure_vehicle(model, recording, v, out);
  return out;
}

}  // namespace engine
