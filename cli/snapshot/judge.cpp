#include "cli/snapshot/judge.h"

#include <fmt/format.h>

#include <cmath>

#include "cli/output/difference.h"
#include "cli/output/json.h"
#include "cli/output/whole_file.h"
#include "engine/measure/definitions.h"
#include "render/error.h"
#include "render/image/compare.h"
#include "render/image/png.h"

namespace cli {
namespace {

namespace fs = std::filesystem;
render::Limits limits_of(const scenes::Scene& scene) {
  render::Limits limits;
  for (const auto& [name, value] : scene.snapshot.limits) set_limit(limits, name, value);
  return limits;
}

std::vector<render::Mask> masks_of(const scenes::Scene& scene, const std::string& camera) {
  std::vector<render::Mask> out;
  for (const scenes::SnapshotMask& mask : scene.snapshot.masks)
    if (mask.camera.empty() || mask.camera == camera) out.push_back({mask.left, mask.top, mask.width, mask.height});
  return out;
}

/// "rms is 0.5 (limit 0.3), ssim is 0.9 (limit 0.995)".
std::string reasons(const render::Difference& found, const render::Limits& limits) {
  std::string out;
  for (const render::Measure* measure : render::beyond(found, limits)) {
    const double value = found.*measure->value;
    out += fmt::format("{}{} is {} (limit {:g})", out.empty() ? "" : ", ", measure->name,
                       value >= 1000 ? fmt::format("{:.0f}", value) : fmt::format("{:.4g}", value), limits.*measure->limit);
  }
  return out;
}

/// The report's pictures of one still. Without a baseline there is only the actual one.
void keep_pictures(const Keeping& keeping, const render::Image& actual, const render::Image* expected,
                   const std::vector<render::Mask>& masks, Json& out) {
  const auto write = [&](const char* kind, const render::Image& image) {
    const fs::path file = keeping.below / fmt::format("{}_{}.png", out["name"].get<std::string>(), kind);
    render::write_png(keeping.report / file, image, {}, render::PngEffort::small);
    out[kind] = file.string();
  };
  make_writable_folder(keeping.report / keeping.below);
  write("actual", actual);
  if (!expected) return;
  write("expected", *expected);
  if (expected->width != actual.width || expected->height != actual.height) {
    const render::Image both[] = {*expected, actual};
    write("side_by_side", render::side_by_side(both));
    return;
  }
  const render::Image difference = render::difference_picture(*expected, actual, masks);
  write("difference", difference);
  const render::Image all[] = {*expected, actual, difference};
  write("side_by_side", render::side_by_side(all));
}

}  // namespace

Json judge(const scenes::Scene& scene, const Still& still, const render::Image& actual, const Keeping& keeping) {
  Json out = {
      {"name", still.name}, {"baseline", still.baseline.string()}, {"camera", still.moment.camera}, {"time_s", still.moment.time}};
  const std::vector<render::Mask> masks = masks_of(scene, still.moment.camera);
  const auto to_look_at = [&](const char* verdict, const std::string& why, const render::Image* expected) {
    out["verdict"] = verdict;
    out["why"] = why;
    keep_pictures(keeping, actual, expected, masks, out);
    return out;
  };
  if (!fs::exists(still.baseline)) {
    if (listed(baseline_folder(scene.path)).contains(still.name))
      return to_look_at("missing", "its baseline was accepted once and is gone", nullptr);
    return to_look_at("new", "it has no baseline yet", nullptr);
  }
  render::Image expected;
  try {
    expected = render::read_png(still.baseline);
  } catch (const render::RenderError& error) {
    return to_look_at("unreadable", error.what(), nullptr);
  }
  if (expected.width != actual.width || expected.height != actual.height) {
    const std::string sizes =
        fmt::format("the baseline is {}x{}, the picture {}x{}", expected.width, expected.height, actual.width, actual.height);
    return to_look_at("different", sizes, &expected);
  }
  const render::Limits limits = limits_of(scene);
  const render::Difference found = render::difference_of(expected, actual, masks);
  out["figures"] = difference_json(found);
  out["limits"] = limits_json(limits);
  if (!render::within(found, limits)) return to_look_at("different", reasons(found, limits), &expected);
  if (keeping.all_that_differ && found.differing > 0) return to_look_at("same", "", &expected);
  out["verdict"] = "same";
  out["why"] = "";
  return out;
}

Json judge_measure(const scenes::Expectation& expected, const std::vector<engine::Metric>& metrics) {
  Json out = {{"metric", expected.metric + (expected.object.empty() ? "" : " " + expected.object)}, {"expected", expected.written}};
  std::vector<const engine::Metric*> found;
  std::vector<std::string> known;
  for (const engine::Metric& metric : metrics) {
    known.push_back(metric.key + (metric.object.empty() ? "" : " " + metric.object));
    if (metric.key == expected.metric && (expected.object.empty() || expected.object == metric.object)) found.push_back(&metric);
  }
  if (found.size() != 1) {
    out["verdict"] = "missing";
    out["why"] =
        fmt::format("{}; the run has {}", found.empty() ? "the run has no such measure" : "several objects have it, name one",
                    known.empty() ? "none" : fmt::format("{}", fmt::join(known, ", ")));
    return out;
  }
  const double value = engine::turned_to(expected.metric, found.front()->value, expected.value), off = value - expected.value;
  // the tolerance as written: a value on its edge is within, whatever the last bit of the difference
  const bool same = std::abs(off) <= expected.tolerance * (1 + 1e-12);
  out["found"] = value;
  out["verdict"] = same ? "same" : "different";
  out["why"] = same ? "" : fmt::format("is {:.6g}, expected {}, off by {:+.3g}", value, expected.written, off);
  return out;
}

}  // namespace cli
