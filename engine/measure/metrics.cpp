#include "engine/measure/metrics.h"

#include "engine/measure/approach.h"

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
  const std::vector<Impact> impacts = impacts_of(model, recording);
  for (int v = 0; v < static_cast<int>(model.vehicles.size()); ++v) {
    measure_vehicle(model, recording, impacts, v, out);
    measure_rollover(model, recording, impacts, v, out);
  }
  if (const auto near = nearest_approach(model, recording)) {
    const std::string pair = model.bodies[near->body_a].name + ", " + model.bodies[near->body_b].name;
    out.push_back({"nearest_approach_m", pair, near->distance});
    out.push_back({"nearest_approach_s", pair, near->time});
  }
  return out;
}

}  // namespace engine
