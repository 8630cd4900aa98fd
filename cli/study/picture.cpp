#include "cli/study/picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "cli/film_plan.h"
#include "cli/output/json.h"
#include "cli/progress.h"
#include "cli/scene_run.h"
#include "cli/study/statistics.h"
#include "cli/study/trial.h"
#include "cli/study/words.h"
#include "render/image/compare.h"

namespace cli::study {
namespace {

namespace charts = render::charts;
using render::Effort;

constexpr int kRepetitions = 5;                                               // after one that warms up
constexpr Effort kReference{4, 2, 4096, 2, 0.10, 256, 0.02};                  // 4 x 4 times the pixels, each with 2 x 2 samples
constexpr double kTessellations[] = {4, 2, 1, 0.5, 0.2, 0.1, 0.05};           // [pixels]
constexpr std::pair<int, int> kSamples[] = {{1, 1}, {1, 2}, {2, 2}, {3, 2}};  // Effort's scale and samples
constexpr int kShadowMaps[] = {128, 256, 512, 1024, 2048, 4096};

std::vector<PictureSetting> settings_of(const scenes::Scene& scene, int width, int height) {
  const Effort own = render::effort_of(quality_of(scene.output.quality), width, height);
  std::vector<PictureSetting> out;
  const auto add = [&](const char* series, const std::string& label, const Effort& effort, bool is_own) {
    out.push_back({series, label, effort, 0, 1, 0, 0, 0, is_own});
  };
  for (const auto& [name, quality] :
       {std::pair{"draft", render::Quality::draft}, {"standard", render::Quality::standard}, {"fine", render::Quality::fine}})
    add("quality", name, render::effort_of(quality, width, height), scene.output.quality == name);
  for (const double share : kTessellations) {
    Effort effort = own;
    effort.pixel_share = share;
    add("tessellation", fmt::format("within {:g} pixel", share), effort, false);
  }
  for (const auto& [scale, samples] : kSamples) {
    Effort effort = own;
    effort.scale = scale;
    effort.samples = samples;
    add("samples", fmt::format("{0} x {0} a pixel", samples * scale), effort, false);
  }
  for (const int size : kShadowMaps) {
    Effort effort = own;
    effort.shadow_map_size = size;
    add("shadow map", fmt::format("{} x {}", size, size), effort, false);
  }
  return out;
}

charts::Chart chart_of(const PictureStudy& study, bool by_ssim) {
  charts::Chart chart;
  chart.title = by_ssim ? "Likeness to the reference" : "Error against the reference";
  chart.x_label = "drawing time a frame on one core [ms]";
  chart.y_label = by_ssim ? "1 - structural similarity (0: the same picture)" : "root mean square over all pixels [1/255]";
  chart.log_x = chart.log_y = true;
  for (const PictureSetting& s : study.settings) {
    if (chart.lines.empty() || chart.lines.back().label != s.series)
      chart.lines.push_back({s.series, {}, true, chart.lines.empty()});
    const double y = by_ssim ? std::max(1 - s.ssim, 1e-6) : std::max(s.rms, 1e-3);
    chart.lines.back().points.push_back({s.frame_ms, y, 0, 0});
    if (s.own) chart.marks.push_back({s.frame_ms, y, "the scene"});
  }
  return chart;
}

charts::Table table_of(const PictureStudy& study) {
  charts::Table table;
  table.title = "All settings (* the scene)";
  const std::vector<std::string> head = {"knob", "setting", "error [1/255]", "similarity", "ms a frame", "quartiles"};
  const auto row = [](const PictureSetting& s) {
    return std::vector<std::string>{s.series,
                                    s.label + (s.own ? " *" : ""),
                                    fmt::format("{:.2f}", s.rms),
                                    fmt::format("{:.4f}", s.ssim),
                                    fmt::format("{:.0f}", s.frame_ms),
                                    fmt::format("{:.0f} to {:.0f}", s.frame_low_ms, s.frame_high_ms)};
  };
  // two columns of settings: the page is wide
  table.head = head;
  table.head.insert(table.head.end(), head.begin(), head.end());
  const std::size_t half = (study.settings.size() + 1) / 2;
  for (std::size_t i = 0; i < half; ++i) {
    table.rows.push_back(row(study.settings[i]));
    if (half + i >= study.settings.size()) continue;
    const std::vector<std::string> right = row(study.settings[half + i]);
    table.rows.back().insert(table.rows.back().end(), right.begin(), right.end());
  }
  return table;
}

const PictureSetting* own_of(const PictureStudy& study) {
  const auto found = std::find_if(study.settings.begin(), study.settings.end(), [](const PictureSetting& s) { return s.own; });
  return found == study.settings.end() ? nullptr : &*found;
}

}  // namespace

PictureStudy study_picture(const scenes::Scene& scene, const engine::Recording& recording, const render::Moment& moment, int width,
                           int height) {
  PictureStudy study{moment, width, height, kReference, 0, settings_of(scene, width, height)};
  const render::DrawList list = render::arrange(scene.stage, recording, moment, static_cast<double>(width) / height);
  render::Image reference;
  {
    render::Renderer renderer(width, height, kReference);
    const double begin = computed_seconds();
    renderer.draw(list, reference);
    study.reference_ms = 1e3 * (computed_seconds() - begin);
  }
  for (PictureSetting& setting : study.settings) {
    render::Renderer renderer(width, height, setting.effort);
    render::Image image;
    std::vector<double> times;
    for (int i = 0; i <= kRepetitions; ++i) {
      const double begin = computed_seconds();
      renderer.draw(list, image);
      if (i > 0) times.push_back(1e3 * (computed_seconds() - begin));
    }
    setting.frame_ms = median(times);
    setting.frame_low_ms = percentile(times, 0.25);
    setting.frame_high_ms = percentile(times, 0.75);
    const render::Difference difference = render::difference_of(reference, image);
    setting.rms = difference.rms;
    setting.ssim = difference.ssim;
  }
  return study;
}

std::string picture_csv(const PictureStudy& study) {
  std::string out = "series,setting,scale,samples,shadow_map,shadow_filter,tessellation_px,rms_255,ssim,frame_ms\n";
  for (const PictureSetting& s : study.settings)
    out += fmt::format("{},{},{},{},{},{},{},{},{},{}\n", s.series, s.label, s.effort.scale, s.effort.samples,
                       s.effort.shadow_map_size, s.effort.shadow_filter, s.effort.pixel_share, s.rms, s.ssim, s.frame_ms);
  return out;
}

Json picture_json(const scenes::Scene& scene, const PictureStudy& study) {
  const auto effort = [](const Effort& e) {
    return Json{{"scale", e.scale},
                {"samples", e.samples},
                {"shadow_map", e.shadow_map_size},
                {"shadow_filter", e.shadow_filter},
                {"tessellation_px", e.pixel_share}};
  };
  Json out = {{"schema", 1}, {"version", CRASHREEL_VERSION}};
  out["scene"] = {{"title", scene.title}, {"path", scene.path.string()}, {"sha256", scene.sha256}, {"overrides", scene.overrides}};
  out["moment"] = {{"time_s", study.moment.time}, {"camera", study.moment.camera}};
  out["size"] = {study.width, study.height};
  out["reference"] = {{"effort", effort(study.reference)}, {"frame_ms", study.reference_ms}};
  for (const PictureSetting& s : study.settings)
    out["settings"].push_back({{"series", s.series},
                               {"setting", s.label},
                               {"own", s.own},
                               {"effort", effort(s.effort)},
                               {"rms_255", s.rms},
                               {"ssim", s.ssim},
                               {"frame_ms", s.frame_ms},
                               {"frame_quartiles_ms", {s.frame_low_ms, s.frame_high_ms}}});
  return out;
}

std::string picture_text(const PictureStudy& study) {
  std::string out =
      fmt::format("  {:<14} {:<18} {:>14} {:>11} {:>11}\n", "knob", "setting", "error [1/255]", "similarity", "ms a frame");
  for (const PictureSetting& s : study.settings)
    out += fmt::format("  {:<14} {:<18} {:>14.3f} {:>11.5f} {:>11.1f}{}\n", s.series, s.label, s.rms, s.ssim, s.frame_ms,
                       s.own ? "  the scene" : "");
  return out;
}

charts::Page picture_page(const scenes::Scene& scene, const PictureStudy& study) {
  charts::Page page;
  const PictureSetting* own = own_of(study);
  page.title = own ? fmt::format("The picture: {:.0f} ms a frame leave an error of {:.1f}/255, a likeness of {:.1f} %",
                                 own->frame_ms, own->rms, 100 * own->ssim)
                   : "What the quality of a picture costs";
  page.subtitle = fmt::format("{}, at {:.3f} s from camera \"{}\", {} x {}", heading_of(scene), study.moment.time,
                              study.moment.camera, study.width, study.height);
  page.findings = {
      fmt::format(
          "The reference is the same moment drawn with 16 times the pixels of 2 x 2 samples each, shadows of {} x {} and surfaces "
          "within {:g} pixel; it takes {:.1f} s.",
          study.reference.shadow_map_size, study.reference.shadow_map_size, study.reference.pixel_share, 1e-3 * study.reference_ms),
      "Each knob is turned alone, the others as the scene has them: where a line runs level, that knob is not what limits the "
      "picture.",
      "Positions are not concerned: a picture shows where the recording says things are, at any quality."};
  page.left = chart_of(study, false);
  page.right = chart_of(study, true);
  page.table = table_of(study);
  page.footer = provenance_of(scene);
  return page;
}

}  // namespace cli::study
