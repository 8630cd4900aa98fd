// Paths of chosen bodies (head and hips, unless the scene names others) up to now.
#include <algorithm>

#include "render/matrix.h"
#include "render/overlays/registration.h"

namespace render {
namespace {

constexpr double kSpacing = 0.02;  // [s] between points

bool wanted(const Frame& frame, const std::string& body) {
  const auto& named = frame.stage.overlays.trace_bodies;
  if (named.empty()) return body.ends_with("/head") || body.ends_with("/hips") || body.ends_with("/waist");
  return std::find(named.begin(), named.end(), body) != named.end();
}

void add_traces(const Frame& frame, DrawList& list) {
  for (std::size_t b = 0; b < frame.recording.body_names.size(); ++b) {
    if (!wanted(frame, frame.recording.body_names[b])) continue;
    LineItem line;
    line.colour = colour_of_part(frame.recording.body_names[b]);
    line.colour[3] = 0.9f;
    line.width = 2.5f;
    line.occluded = Occluded::hidden;
    double last = -1;
    for (const auto& s : frame.recording.snapshots) {
      if (s.time > frame.now.time) break;
      if (s.time - last < kSpacing - 1e-9) continue;
      last = s.time;
      line.points.push_back(to_float(s.bodies[b].X_WB.p));
    }
    line.points.push_back(to_float(frame.now.bodies[b].X_WB.p));
    if (line.points.size() > 1) list.lines.push_back(std::move(line));
  }
}

}  // namespace

struct Traces {
  static constexpr OverlayKey kKeys[] = {{"traces", 0, "Paths of the bodies in trace_bodies."}};
  static constexpr Overlay kOverlay{"traces", kKeys, add_traces};
};
template struct Drawn<Traces>;

}  // namespace render
