// What the viewer must know: time, speeds, camera, slow motion; who made it and that it is a simulation; scale on top views.
#include <fmt/format.h>

#include <cmath>

#include "render/matrix.h"
#include "render/overlays/movers.h"
#include "render/overlays/registration.h"

namespace render {
namespace {

constexpr Float4 kWarning{1, 0.45f, 0.35f, 1};

const Float4 kAmber{1, 0.70f, 0.25f, 1};

std::string speed_factor(double speed) {
  if (speed == 0) return "freeze";
  const double inverse = 1 / speed;
  if (std::abs(inverse - std::round(inverse)) < 1e-6 && inverse > 1) return fmt::format("slow motion 1/{:.0f}", inverse);
  return fmt::format("speed x{:g}", speed);
}

void add_caption(const Frame& frame, DrawList& list) {
  LabelItem label;
  label.always = true;  // warnings too
  label.anchor = {0.016f, 0.972f};
  label.pivot = {0, 1};
  std::string clock = fmt::format("t = {:.3f} s", frame.now.time);
  if (frame.moment.speed != 1) clock += "    " + speed_factor(frame.moment.speed);
  label.lines.push_back(clock);
  label.sizes.push_back(30);
  label.colours.push_back(kWhiteText);
  std::string speeds;
  for (const Mover& mover : frame.stage.speeds) {
    if (!speeds.empty()) speeds += kItemGap;
    speeds += fmt::format("{} {:.1f} km/h", mover.name, 3.6 * velocity_of(mover, frame.now).norm());
  }
  if (!speeds.empty()) {
    label.lines.push_back(speeds);
    label.sizes.push_back(22);
    label.colours.push_back(kAmber);
  }
  label.lines.push_back(frame.stage.title + " \u00b7 camera " + frame.camera.name +
                        (frame.moment.second.empty() ? "" : " and " + frame.moment.second));
  label.sizes.push_back(18);
  label.colours.push_back(kPaleText);
  for (const std::string& warning : frame.stage.warnings) {
    label.lines.push_back(warning);
    label.sizes.push_back(18);
    label.colours.push_back(kWarning);
  }
  list.labels.push_back(label);
}

void add_disclaimer(const Frame& frame, DrawList& list) {
  LabelItem label;
  label.always = true;
  label.anchor = {0.984f, 0.972f};
  label.pivot = {1, 1};
  label.lines = {"Simulation, not footage"};
  if (!frame.stage.provenance.empty()) label.lines.push_back(frame.stage.provenance);
  label.sizes.assign(label.lines.size(), 16);
  label.colours.assign(label.lines.size(), {0.92f, 0.94f, 0.96f, 0.95f});
  label.sizes[0] = 19;
  // without the caption a warning stands here: it can not be switched off
  for (const std::string& warning : frame.stage.warnings) {
    if (frame.stage.overlays.on("caption")) break;
    label.lines.push_back(warning);
    label.sizes.push_back(18);
    label.colours.push_back(kWarning);
  }
  list.labels.push_back(label);
}

/// A bar of a round number of metres, drawn on the ground in the lower part of a top view, and an arrow to the north (along +x
/// while nobody has said where north is).
void add_scale_bar(const Frame& frame, DrawList& list) {
  const double seen = list.view.vertical_extent;
  const double wanted = seen / 5;
  double length = std::pow(10, std::floor(std::log10(wanted)));
  if (length * 5 <= wanted)
    length *= 5;
  else if (length * 2 <= wanted)
    length *= 2;
  const Mat4 to_world = from_gl(list.view.world_to_eye).inverse();
  auto on_ground = [&](double right, double up) -> Vec3 {
    const Eigen::Vector4d p = to_world * Eigen::Vector4d(right, up, 0, 1);
    return {p.x(), p.y(), frame.stage.road.height};
  };
  const double half_width = 0.5 * seen * frame.aspect;
  const double x1 = half_width * 0.95, x0 = x1 - length,
               y = (frame.stage.overlays.on("legend") ? -0.38 : 0.40) * seen;  // the legend's corner
  auto line = [&](double ax, double ay, double bx, double by) {
    LineItem item;
    item.points = {to_float(on_ground(ax, ay)), to_float(on_ground(bx, by))};
    item.width = 3;
    list.lines.push_back(item);
  };
  line(x0, y, x1, y);
  line(x0, y - 0.01 * seen, x0, y + 0.01 * seen);
  line(x1, y - 0.01 * seen, x1, y + 0.01 * seen);
  LabelItem label;
  label.lines = {fmt::format("{:g} m", length)};
  label.sizes = {20};
  label.colours = {kWhiteText};
  label.at_world_point = true;
  label.world = to_float(on_ground(0.5 * (x0 + x1), y));
  label.pivot = {0.5f, 1.1f};
  list.labels.push_back(label);
  const double bearing = frame.stage.north.value_or(0);
  const Vec3 along = Vec3(std::cos(bearing), std::sin(bearing), 0);
  const bool charts = frame.stage.overlays.on("speed_chart") || frame.stage.overlays.on("energy_chart");
  const Vec3 middle = on_ground(-half_width * 0.92 + 0.045 * seen, (charts ? -0.16 : 0.34) * seen);
  list.arrows.push_back({to_float(middle - 0.045 * seen * along), to_float(middle + 0.045 * seen * along), {1, 1, 1, 1}, 4});
  LabelItem north = label;
  north.lines = {frame.stage.north ? "N" : "x"};
  north.world = to_float(middle + (frame.stage.north ? 0.065 : 0.055) * seen * along);
  north.pivot = {frame.stage.north ? 0.5f : 0.0f, 0.5f};
  north.plate = false;
  list.labels.push_back(north);
}

}  // namespace

struct Caption {
  static constexpr OverlayKey kKeys[] = {{"caption", 1, "Time, speeds, camera."}};
  static constexpr Overlay kOverlay{"caption", kKeys, add_caption, nullptr, Belongs::picture};
};
template struct Drawn<Caption>;

struct ScaleBar {
  static constexpr OverlayKey kKeys[] = {{"scale_bar", 1, "A bar of metres in top views."}};
  static constexpr Overlay kOverlay{"scale_bar", kKeys, add_scale_bar, [](const Frame& f) {
                                      return f.stage.overlays.on("scale_bar") && f.camera.kind == CameraKind::top;
                                    }};
};
template struct Drawn<ScaleBar>;

struct Disclaimer {
  static constexpr OverlayKey kKeys[] = {{"disclaimer", 1, "\"Simulation, not footage\" and the provenance at the foot."}};
  static constexpr Overlay kOverlay{"disclaimer", kKeys, add_disclaimer,
                                    [](const Frame& f) {
                                      const bool unsaid = !f.stage.warnings.empty() && !f.stage.overlays.on("caption");
                                      return f.stage.overlays.on("disclaimer") || unsaid;
                                    },
                                    Belongs::picture};
};
template struct Drawn<Disclaimer>;

}  // namespace render
