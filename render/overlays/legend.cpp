// What the colours and lengths of arrows, traces and marks mean. Only what the picture shows is named.
#include <fmt/format.h>

#include <algorithm>

#include "render/overlays/registration.h"

namespace render {
namespace {

void line(LabelItem& label, const std::string& text, const Float4& colour) {
  label.lines.push_back(text);
  label.sizes.push_back(17);
  label.colours.push_back(colour);
}

/// The parts of a person, once each: one body stands for all that share its colour.
void add_parts(const Frame& frame, LabelItem& label) {
  if (frame.stage.persons.empty()) return;
  for (const auto& [name, part] :
       {std::pair{"head, neck", "head"}, {"trunk", "torso"}, {"arms", "arm"}, {"thighs", "thigh"}, {"lower legs, feet", "calf"}})
    line(label, std::string("\u25a0 ") + name, colour_of_part(part));
}

void add_history(const Frame& frame, LabelItem& label) {
  const bool by_time = frame.stage.overlays.contact_colour == ContactColour::time;
  double last = 0, strongest = 0;
  for (const engine::Snapshot& s : frame.recording.snapshots)
    for (const engine::ContactRecord& c : s.contacts) {
      if (!c.shapes.on_vehicle() || c.body_b < 0 || c.impulse.norm() < 0.2) continue;
      last = s.time;
      strongest = std::max(strongest, c.impulse.norm());
    }
  line(label, by_time ? "marks: time of touch" : "marks: impulse of touch", kWhiteText);
  for (const double share : {0.0, 0.5, 1.0})
    line(label, "\u25cf " + (by_time ? fmt::format("{:.2f} s", share * last) : fmt::format("{:.0f} N s", share * strongest)),
         colour_of_share(share));
}

void add_legend(const Frame& frame, DrawList& list) {
  const Overlays& o = frame.stage.overlays;
  LabelItem label;
  label.anchor = {0.984f, 0.028f};
  label.pivot = {1, 0};
  if (o.on("forces") || o.on("traces")) add_parts(frame, label);
  if (o.on("forces")) line(label, fmt::format("force: 1 m of arrow = {:g} kN", o.of("force_scale") / 1000), kPaleText);
  if (o.on("velocities")) line(label, fmt::format("velocity: 1 m of arrow = {:g} km/h", 3.6 * o.of("velocity_scale")), kPaleText);
  if (o.on("contact_history")) add_history(frame, label);
  if (o.on("ghost_interval")) line(label, fmt::format("pale figures every {:g} s", o.of("ghost_interval")), kPaleText);
  if (o.on("ghost_distance")) line(label, fmt::format("pale figures every {:g} m", o.of("ghost_distance")), kPaleText);
  if (!label.lines.empty()) list.labels.push_back(label);
}

}  // namespace

struct Legend {
  static constexpr OverlayKey kKeys[] = {{"legend", 0, "What colours and lengths of arrows and marks mean."}};
  static constexpr Overlay kOverlay{"legend", kKeys, add_legend, nullptr, Belongs::picture};
};
template struct Drawn<Legend>;

}  // namespace render
