// What snapshot tests hold the scene to: [snapshot] for its pictures, [expect] for its measures.
#include <fmt/format.h>

#include <algorithm>

#include "engine/model/model.h"
#include "scenes/loader/builder.h"
#include "scenes/loader/metric_unit.h"

namespace scenes {
namespace {

const Key kLimitKeys[] = {
    {"share_above_2", Type::number, Dimension::none, "0.005", "Share of pixels off by more than 2 of 255.", kShare},
    {"pixels_above_32", Type::number, Dimension::none, "50", "Pixels off by more than 32 of 255.", kNotNegative},
    {"rms", Type::number, Dimension::none, "0.3", "Root mean square difference of all channels, of 255.", kNotNegative},
    {"psnr_dB", Type::number, Dimension::none, "55", "Peak signal-to-noise ratio, at least.", kNotNegative},
    {"ssim", Type::number, Dimension::none, "0.995", "Structural similarity, at least.", between(-1, 1)},
    {"perceptual_mean", Type::number, Dimension::none, "0.01", "What an eye notices, mean over the picture.", kShare},
    {"perceptual_worst", Type::number, Dimension::none, "0.08", "What an eye notices at the worst place of the picture.", kShare},
};
const Section kLimitsSection{"snapshot.limits", "[snapshot.limits]", "How far a picture may be from its baseline.", kLimitKeys};

const Key kMaskKeys[] = {
    bound<&SnapshotMask::camera>(
        {"camera", Type::text, Dimension::none, "''", "Only in pictures of this camera; left out: in all."}),
    bound<&SnapshotMask::left>({"left", Type::integer, Dimension::none, "0", "Pixels from the left edge.", kNotNegative}),
    bound<&SnapshotMask::top>({"top", Type::integer, Dimension::none, "0", "Pixels from the upper edge.", kNotNegative}),
    bound<&SnapshotMask::width>({"width", Type::integer, Dimension::none, kRequired, "Pixels across.", at_least(1)}),
    bound<&SnapshotMask::height>({"height", Type::integer, Dimension::none, kRequired, "Pixels down.", at_least(1)}),
};
const Section kMaskSection{"snapshot.mask", "[[snapshot.mask]]", "A rectangle of the picture that is not compared.", kMaskKeys};

const Key kSnapshotKeys[] = {
    bound<&SnapshotTest::width>({"width", Type::integer, Dimension::none, "320", "Picture width in pixels.", between(16, 8192)}),
    bound<&SnapshotTest::height>({"height", Type::integer, Dimension::none, "180", "Picture height in pixels.", between(16, 8192)}),
    {"limits", Type::table, Dimension::none, "", "Limits of the comparison.", kAny, {}, &kLimitsSection},
    {"mask", Type::tables, Dimension::none, "", "What is not compared.", kAny, {}, &kMaskSection},
};

const Key kExpectKeys[] = {
    {"*", Type::text, Dimension::none, "",
     "A measure of summary.json, with or without its unit, and its tolerance: `throw_distance = \"12.3 m +- 0.1 m\"`. Where "
     "several objects have it: `\"throw_distance pedestrian\"`."},
};

std::string_view without_blanks(std::string_view text) {
  while (!text.empty() && text.front() == ' ') text.remove_prefix(1);
  while (!text.empty() && text.back() == ' ') text.remove_suffix(1);
  return text;
}

/// "throw_distance pedestrian" = "12.3 m +- 0.1 m". The unit written decides which measure is meant.
void read_expectation(Builder& builder, Reader& r, const std::string& key) {
  const std::string text = r.text(key);
  constexpr const char* kRemedy = "must be a value and its tolerance with the same kind of unit, like \"12.3 m +- 0.1 m\"";
  std::size_t sign = text.find("+-"), sign_length = 2;
  if (sign == std::string::npos) sign = text.find("\u00b1");  // as long in UTF-8
  if (sign == std::string::npos) return r.fail(key, kRemedy);
  const std::string_view value = without_blanks(std::string_view(text).substr(0, sign));
  const std::string_view tolerance = without_blanks(std::string_view(text).substr(sign + sign_length));
  for (const MetricUnit& unit : kMetricUnits) {
    // a bare zero is of every dimension: only a text with a unit, or the last line of the table, decides
    const bool bare = tolerance.find_first_not_of("0123456789.eE+-") == std::string_view::npos;
    if (bare != (unit.dimension == Dimension::none)) continue;
    const Quantity v = parse_quantity(value, unit.dimension), t = parse_quantity(tolerance, unit.dimension);
    if (!v.problem.empty() || !t.problem.empty()) continue;
    if (t.value < 0) return r.fail(key, "has a negative tolerance");
    Expectation out;
    const std::size_t space = key.find(' ');
    out.metric = key.substr(0, space);
    if (space != std::string::npos) out.object = key.substr(space + 1);
    if (!out.metric.ends_with(unit.suffix)) out.metric += unit.suffix;
    out.value = v.value * unit.per_si;
    out.tolerance = t.value * unit.per_si;
    out.written = text;
    builder.scene.snapshot.expectations.push_back(std::move(out));
    return;
  }
  r.fail(key, kRemedy);
}

}  // namespace

const Section kSnapshotSection{"snapshot", "[snapshot]",
                               "How `crashreel snapshot` draws the stills of this scene and holds them against their baselines.",
                               kSnapshotKeys};
const Section kExpectSection{"expect", "[expect]",
                             "Measures that `crashreel snapshot` checks beside the pictures, so that a change of physics is told "
                             "from a change of drawing.",
                             kExpectKeys};

void read_snapshot(Builder& builder, std::optional<Reader> snapshot, std::optional<Reader> expect) {
  SnapshotTest& test = builder.scene.snapshot;
  if (snapshot) {
    snapshot->fill(test);
    if (auto limits = snapshot->table("limits")) {
      for (const Entry& entry : limits->value().entries)
        if (kLimitsSection.find(entry.key)) test.limits[entry.key] = limits->number(entry.key);
    }
    for (Reader& mask : snapshot->tables("mask")) {
      SnapshotMask out;
      mask.fill(out);
      const auto& cameras = builder.scene.stage.cameras;
      const auto same_name = [&out](const render::Camera& camera) { return camera.name == out.camera; };
      if (!out.camera.empty() && std::none_of(cameras.begin(), cameras.end(), same_name))
        mask.fail("camera", "is no camera of the scene");
      test.masks.push_back(std::move(out));
    }
  }
  if (expect) {
    for (const Entry& entry : expect->value().entries) read_expectation(builder, *expect, entry.key);
  }
}

}  // namespace scenes
