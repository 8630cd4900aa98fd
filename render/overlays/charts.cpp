// Speed and energy over time, drawn as far as the film has come. The axes are those of the whole run and never jump.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "render/overlays/movers.h"
#include "render/overlays/registration.h"

namespace render {
namespace {

constexpr std::size_t kPoints = 300;  // of a curve: one a pixel of its width

/// Apart for the colour-blind too: hues of M. Okabe & K. Ito, Color Universal Design, 2008, lighter for the dark plate.
constexpr Float4 kColours[] = {{1, 0.70f, 0.25f, 1},     {0.45f, 0.85f, 1, 1},     {0.10f, 0.72f, 0.52f, 1},
                               {0.92f, 0.55f, 0.80f, 1}, {0.97f, 0.94f, 0.35f, 1}, {0.32f, 0.55f, 0.98f, 1},
                               {0.95f, 0.38f, 0.12f, 1}, {0.96f, 0.96f, 0.96f, 1}};

/// The next round number, one whose half is short too.
double round_up(double x) {
  if (!(x > 0)) return 1;
  const double power = std::pow(10, std::floor(std::log10(x)));
  for (const double m : {1.0, 1.2, 1.6, 2.0, 2.4, 3.0, 4.0, 5.0, 6.0, 8.0})
    if (x <= m * power * (1 + 1e-12)) return m * power;
  return 10 * power;
}

/// Adds a curve of `value` over the run and raises the ceiling to hold all of it; its points end now.
template <typename Value>
void add_series(const Frame& frame, ChartItem& chart, const std::string& name, const Float4& colour, Value value) {
  ChartItem::Series series{name, colour, {}};
  const auto& snapshots = frame.recording.snapshots;
  const std::size_t stride = std::max<std::size_t>(1, snapshots.size() / kPoints);
  double highest = 0;
  for (std::size_t i = 0; i < snapshots.size(); ++i) {
    const double y = value(snapshots[i]);
    highest = std::max(highest, y);
    if (i % stride == 0 && snapshots[i].time <= frame.now.time)
      series.points.push_back({static_cast<float>(snapshots[i].time), static_cast<float>(y)});
  }
  series.points.push_back({static_cast<float>(frame.now.time), static_cast<float>(value(frame.now))});
  chart.ceiling = std::max(chart.ceiling, round_up(highest));
  chart.series.push_back(std::move(series));
}

ChartItem empty_chart(const Frame& frame, const std::string& title, std::size_t place) {
  ChartItem chart;
  chart.title = title;
  chart.end = std::max(frame.recording.end_time(), 1e-3);
  chart.ceiling = 0;
  chart.now = frame.now.time;
  // below each other; beside each other, in the sky, where a pane is narrow and what happens stands in its middle
  const float step = static_cast<float>(place);
  const bool narrow = frame.moment.layout == Layout::split;
  chart.anchor = {0.016f + (narrow ? 0.230f * step : 0), 0.028f + (narrow ? 0 : 0.235f * step)};
  return chart;
}

void add_charts(const Frame& frame, DrawList& list) {
  const Overlays& o = frame.stage.overlays;
  if (o.on("speed_chart") && !frame.stage.speeds.empty()) {
    ChartItem chart = empty_chart(frame, "speed, km/h", list.charts.size());
    const std::vector<Mover>& movers = frame.stage.speeds;
    const std::size_t shown = std::min(movers.size(), std::size(kColours));
    for (std::size_t i = 0; i < shown; ++i)
      add_series(frame, chart, movers[i].name, kColours[i],
                 [&mover = movers[i]](const engine::Snapshot& s) { return 3.6 * velocity_of(mover, s).norm(); });
    chart.left_out = static_cast<int>(movers.size() - shown);
    list.charts.push_back(std::move(chart));
  }
  if (o.on("energy_chart")) {
    ChartItem chart = empty_chart(frame, "energy, kJ", list.charts.size());
    add_series(frame, chart, "kinetic", {0.45f, 0.85f, 1, 1}, [](const engine::Snapshot& s) { return s.energies.kinetic / 1000; });
    add_series(frame, chart, "dissipated", {1, 0.50f, 0.35f, 1}, [](const engine::Snapshot& s) {
      return std::accumulate(s.energies.dissipated.begin(), s.energies.dissipated.end(), 0.0) / 1000;
    });
    list.charts.push_back(std::move(chart));
  }
}

}  // namespace

struct Charts {
  static constexpr OverlayKey kKeys[] = {{"speed_chart", 0, "Speeds over time, running with the film."},
                                         {"energy_chart", 0, "Energies over time, running with the film."}};
  static constexpr Overlay kOverlay{
      "charts", kKeys, add_charts,
      [](const Frame& f) { return f.stage.overlays.on("speed_chart") || f.stage.overlays.on("energy_chart"); }, Belongs::picture};
};
template struct Drawn<Charts>;

}  // namespace render
