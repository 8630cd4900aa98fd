// Contact points and normals; force arrows with numbers at the largest.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "render/matrix.h"
#include "render/overlays/registration.h"

namespace render {
namespace {

constexpr double kLeastForce = 50;      // [N] below it nothing is drawn: a resting contact of a hand
constexpr double kLinearTo = 1.2;       // [m] longer arrows grow with the logarithm only, so that they stay in the picture
constexpr double kNormalLength = 0.10;  // [m]
constexpr double kHold = 0.08;          // [s] the largest contact keeps its label this long, to be read

bool of_interest(const engine::ContactRecord& c) {
  return c.normal_force > kLeastForce && !c.exchange;  // impulses of vehicles have an overlay of their own
}

void add_contacts(const Frame& frame, DrawList& list) {
  for (const auto& c : frame.now.contacts) {
    if (!of_interest(c)) continue;
    list.markers.push_back({to_float(c.point), {1, 1, 1, 1}, 4, Occluded::faint});
    LineItem normal;
    normal.points = {to_float(c.point), to_float(c.point + kNormalLength * c.normal)};
    normal.colour = {1, 1, 1, 0.95f};
    normal.width = 1.6f;
    normal.occluded = Occluded::faint;
    list.lines.push_back(normal);
  }
}

double arrow_length(double force, double newtons_per_metre) {
  const double linear = force / newtons_per_metre;
  return linear <= kLinearTo ? linear : kLinearTo * (1 + 0.4 * std::log(linear / kLinearTo));
}

std::string newtons(double force) {
  return force >= 1000 ? fmt::format("{:.1f} kN", force / 1000) : fmt::format("{:.0f} N", force);
}

void add_forces(const Frame& frame, DrawList& list) {
  const engine::ContactRecord* largest = nullptr;
  for (const auto& c : frame.now.contacts) {
    if (!of_interest(c)) continue;
    const std::string& part = frame.recording.body_names[static_cast<std::size_t>(c.body_a)];
    const double force = c.force.norm();
    const Vec3 tip = c.point + c.force / force * std::max(0.12, arrow_length(force, frame.stage.overlays.of("force_scale")));
    list.arrows.push_back({to_float(c.point), to_float(tip), colour_of_part(part), 4.5f, Occluded::faint});
    if (c.shapes.on_vehicle() && (!largest || force > largest->force.norm())) largest = &c;
  }
  // impacts last a millisecond: the label of the largest of the last moments stays long enough to be read
  engine::ContactRecord held;
  if (!largest) {
    for (const auto& s : frame.recording.snapshots) {
      if (s.time > frame.now.time) break;
      if (s.time < frame.now.time - kHold * std::max(frame.moment.speed, 0.05)) continue;
      for (const auto& c : s.contacts)
        if (c.shapes.on_vehicle() && of_interest(c) && (!largest || c.force.norm() > held.force.norm())) {
          held = c;
          // the label goes on with the part it speaks of
          const auto part = static_cast<std::size_t>(c.body_a);
          held.point = frame.now.bodies[part].X_WB * (s.bodies[part].X_WB.inverse() * c.point);
          largest = &held;
        }
    }
  }
  if (!largest) return;
  LabelItem label;
  const auto& names = frame.recording.body_names;
  const std::string against = largest->body_b >= 0 ? names[static_cast<std::size_t>(largest->body_b)] : "ground";
  const std::string& part = names[static_cast<std::size_t>(largest->body_a)];
  // of one person "left thigh", of several "boy's left thigh"
  const std::size_t slash = part.find('/');
  const std::string whose = frame.stage.persons.size() > 1 && slash != std::string::npos ? part.substr(0, slash) + "'s " : "";
  label.lines = {whose + readable(part) + " / " + against,
                 largest->state == engine::ContactState::impact
                     ? fmt::format("impulse {:.0f} N s", std::hypot(largest->normal_impulse, largest->tangential_impulse))
                     : fmt::format("F = {}", newtons(largest->force.norm()))};
  label.sizes = {20, 20};
  label.colours = {{1, 1, 1, 1}, {1, 0.68f, 0.25f, 1}};
  label.at_world_point = true;
  label.world = to_float(largest->point);
  label.pivot = {-0.7f, 3.2f};  // clear of the figure it speaks of
  label.leader = true;
  list.labels.push_back(label);
}

}  // namespace

struct Contacts {
  static constexpr OverlayKey kKeys[] = {
      {"contacts", 1, "Contact points and normals; faint where something stands well before them."}};
  static constexpr Overlay kOverlay{"contacts", kKeys, add_contacts};
};
template struct Drawn<Contacts>;

struct Forces {
  static constexpr OverlayKey kKeys[] = {{"forces", 1, "Arrows, long by force; faint as contacts are."},
                                         {"force_scale", 10e3, "Force that one metre of arrow stands for.", "N/m"}};
  static constexpr Overlay kOverlay{"forces", kKeys, add_forces};
};
template struct Drawn<Forces>;

}  // namespace render
