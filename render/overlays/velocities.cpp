// Velocity arrows of those whose speed the caption tells, with the number at the tip.
#include <fmt/format.h>

#include "render/matrix.h"
#include "render/overlays/movers.h"
#include "render/overlays/registration.h"

namespace render {
namespace {

constexpr double kLeastSpeed = 0.3;  // [m/s] slower is a point
const Float4 kVelocityColour{0.45f, 0.85f, 1.0f, 1};

void add_velocities(const Frame& frame, DrawList& list) {
  for (const Mover& mover : frame.stage.speeds) {
    const Vec3 centre = centre_of(mover, frame.now), v = velocity_of(mover, frame.now);
    const double speed = v.norm();
    if (speed < kLeastSpeed) continue;
    const Vec3 tip = centre + v / frame.stage.overlays.of("velocity_scale");
    list.arrows.push_back({to_float(centre), to_float(tip), kVelocityColour, 5});
    LabelItem label;
    label.lines = {fmt::format("{} {:.1f} km/h", mover.name, 3.6 * speed)};
    label.sizes = {18};
    label.colours = {kVelocityColour};
    label.at_world_point = true;
    label.world = to_float(tip);
    label.pivot = {-0.05f, 0.5f};
    list.labels.push_back(label);
  }
}

}  // namespace

struct Velocities {
  static constexpr OverlayKey kKeys[] = {{"velocities", 0, "Velocity arrows of vehicles and persons, with numbers."},
                                         {"velocity_scale", 8, "Speed that one metre of arrow stands for.", "m/s"}};
  static constexpr Overlay kOverlay{"velocities", kKeys, add_velocities};
};
template struct Drawn<Velocities>;

}  // namespace render
