#include "cli/study/page.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "cli/scene_run.h"
#include "cli/study/output.h"
#include "cli/study/perturb.h"
#include "cli/study/words.h"

namespace cli::study {
namespace {

namespace charts = render::charts;

std::string label_with_unit(const std::string& quantity) {
  const std::string unit = unit_of(quantity);
  return unit.empty() ? words_of(quantity) : fmt::format("{} [{}]", words_of(quantity), unit);
}

/// Errors that vanish to rounding have no place on a logarithmic axis: they stand at what can be told apart.
double drawable(double error, double reference) {
  return std::max(std::abs(error), 1e-13 * std::max(std::abs(reference), 1.0));
}

charts::Chart work_precision(const Study& study, const Judgement& j) {
  charts::Chart chart;
  chart.title = "What accuracy costs";
  chart.x_label = "computing time on one core [s]";
  chart.y_label = fmt::format("error of the {}, against {}", label_with_unit(j.quantity),
                              j.error_kind == "closed_form"     ? std::string("the closed form")
                              : j.error_kind == "richardson"    ? "the limit of the steps"
                              : j.error_kind == "second_scheme" ? "the limit of " + j.second_scheme
                              : j.error_kind == "median"        ? "the median of the finest steps"
                                                                : "the finest step");
  chart.log_x = chart.log_y = true;
  for (const SeriesResult& series : study.series) {
    if (series.series.other_law || series.series.varies == kStartsVary) continue;
    charts::Line line{series.series.name, {}, true, &series == &study.series.front()};
    for (std::size_t i = 0; i < series.settings.size(); ++i) {
      const Answer* a = answer_of(series.settings[i], j.quantity);
      // the finest run is the reference where there is no other: its own error is not 0, it is not known
      const bool is_reference = j.error_kind == "finest" && line.emphasised && i + 1 == series.settings.size();
      // a setting whose answer happens to be the middle of the cloud is not without error
      const bool is_middle = j.error_kind == "median" && a && std::abs(a->error) < 1e-9 * std::abs(j.reference);
      if (!a || is_reference || is_middle) continue;
      line.points.push_back({series.settings[i].wall_s, drawable(a->error, j.reference), 0, 0});
      if (series.settings[i].setting.own) chart.marks.push_back({line.points.back().x, line.points.back().y, "the scene"});
    }
    if (!line.points.empty()) chart.lines.push_back(std::move(line));
  }
  // a machine-independent scale: the steps of the scene's own ladder stand where they were paid for
  chart.top_label = fmt::format("steps computed, {}", study.series.front().series.name);
  for (const SettingResult& r : study.series.front().settings)
    if (r.failure.empty()) chart.top.push_back({r.wall_s, 0, fmt::format("{}", r.steps)});
  return chart;
}

charts::Chart answer_against_step(const Study& study, const Judgement& j) {
  const SeriesResult& ladder = study.series.front();
  charts::Chart chart;
  chart.title = "The answer at each " + ladder.series.varies;
  chart.x_label = ladder.series.varies == "step" ? "step [ms]" : ladder.series.varies;
  chart.y_label = label_with_unit(j.quantity);
  chart.log_x = true;
  charts::Line line{"answer", {}, true, true};
  charts::Band band{j.convergence.trust == Trust::steady ? "grid-convergence band" : "range of this and finer steps", {}};
  charts::Line cloud{"5th to 95th percentile of minute changes", {}, false, false};
  for (const SettingResult& result : ladder.settings) {
    const Answer* a = answer_of(result, j.quantity);
    if (!a) continue;
    const double x = (ladder.series.varies == "step" ? 1e3 : 1.0) * result.setting.fineness;
    const double centre = j.cloud ? a->middle : a->value;
    line.points.push_back({x, a->value, 0, 0});
    if (!is_defect(j.quantity)) band.points.push_back({x, 0, centre - a->uncertainty, centre + a->uncertainty});
    if (result.setting.members > 0 && a->high > a->low) cloud.points.push_back({x, a->middle, a->low, a->high});
    if (result.setting.own) chart.marks.push_back({x, a->value, "the scene"});
  }
  chart.bands.push_back(std::move(band));
  chart.lines.push_back(std::move(line));
  if (j.cloud) chart.lines.push_back(std::move(cloud));
  if (j.error_kind == "closed_form") chart.levels.push_back({0, j.reference, "closed form"});
  if (j.error_kind == "richardson") chart.levels.push_back({0, j.reference, "limit"});
  return chart;
}

/// A measure that runs at an end of a range do not have, as no flight, has no share of it: that is not nought.
std::string input_share(const Study& study, const std::string& quantity, const std::string& unit) {
  if (study.inputs.empty()) return "not given";
  const bool everywhere = std::all_of(study.inputs.begin(), study.inputs.end(),
                                      [&quantity](const auto& input) { return input.half_width.contains(quantity); });
  return everywhere ? with_unit(study.input_uncertainty(quantity), unit) : "not at each end";
}

/// Each quantity's share is told relative to its value, so that metres and seconds stand in one picture. More than all of it, as of
/// a time that is nearly zero, would leave no room for the others.
charts::Bars uncertainty_bars(const Study& study) {
  charts::Bars bars;
  bars.title = "Uncertainty of the scene as it stands (\u00b1), as a share of the answer";
  bars.parts = {"numerical", "sensitivity", "input"};
  const SettingResult* own = study.own();
  if (!own) return bars;
  // what the page is about first, then what a screen of results shows: the page has room for some
  const std::string main = main_quantity(study);
  std::vector<const Judgement*> told;
  for (const Judgement& j : study.judgements)
    if (!is_defect(j.quantity) && (is_on_screen(j.quantity) || j.quantity == main)) told.push_back(&j);
  std::stable_partition(told.begin(), told.end(), [&main](const Judgement* j) { return j->quantity == main; });
  for (const Judgement* judged : told) {
    const Judgement& j = *judged;
    const Answer* a = answer_of(*own, j.quantity);
    if (!a) continue;
    const double input = study.input_uncertainty(j.quantity), sensitivity = (a->high - a->low) / 2;
    // of a place that happens to be nought: nanometres are no full bar
    constexpr double kLeast = 1e-3;  // in its unit, what could be measured
    const double size = std::max({std::abs(a->value), a->uncertainty + sensitivity + input, kLeast});
    const std::string unit = unit_of(j.quantity);
    bars.rows.push_back({words_of(j.quantity),
                         {a->uncertainty / size, sensitivity / size, input / size},
                         {with_unit(a->uncertainty, unit), with_unit(sensitivity, unit), input_share(study, j.quantity, unit)}});
  }
  return bars;
}

charts::Table convergence_table(const Study& study, const Judgement& j) {
  const SeriesResult& ladder = study.series.front();
  const std::vector<std::string> letters = sequence_letters(ladder);
  const std::string unit = unit_of(j.quantity);
  charts::Table table;
  table.title = fmt::format("Convergence of the {}", words_of(j.quantity));
  table.head = {ladder.series.varies, "answer",   "change", j.convergence.trust == Trust::range ? "range \u00b1" : "band \u00b1",
                "spread \u00b1",      "contacts", "time",   "steps"};
  const Answer* before = nullptr;
  const double finest = std::max(j.convergence.band.back(), j.beside_the_step());
  for (std::size_t i = 0; i < ladder.settings.size(); ++i) {
    const SettingResult& r = ladder.settings[i];
    const Answer* a = answer_of(r, j.quantity);
    const std::string label = r.setting.label.substr(r.setting.label.find(' ') + 1);
    if (!a) {
      table.rows.push_back({label, r.failure.empty() ? "none" : "diverged", "", "", "", letters[i], with_unit(r.wall_s, "s"), ""});
      before = nullptr;
      continue;
    }
    if (r.setting.own) table.emphasised = static_cast<int>(i);
    table.rows.push_back({label, fmt::format("{} {}", with_digits(a->value, finest), unit),
                          before ? with_unit(a->value - before->value, unit) : "", with_unit(a->uncertainty, unit),
                          with_unit((a->high - a->low) / 2, unit), letters[i], with_unit(r.wall_s, "s"),
                          fmt::format("{}", r.steps)});
    before = a;
  }
  const bool one = std::all_of(letters.begin(), letters.end(), [](const std::string& l) { return l == "A"; });
  table.note =
      one ? "Contacts: every step had the same bodies touch in the same order."
          : "Contacts: equal letters had the same bodies touch in the same order; where the letter changes, a band would be a "
            "guess and the range of the answers stands in its place.";
  if (std::isfinite(j.convergence.order)) table.note += fmt::format(" Observed order {:.2f}.", j.convergence.order);
  table.note += j.second_scheme.empty()
                    ? std::string(" No other scheme takes another way to this answer, so no band is claimed, only a range.")
                    : fmt::format(" The second scheme, {}, tends to {}.", j.second_scheme,
                                  j.schemes_agree ? "the same answer" : "another answer: the range holds both");
  return table;
}

}  // namespace

charts::Page page_of(const scenes::Scene& scene, const Study& study) {
  charts::Page page;
  const std::string quantity = main_quantity(study);
  const std::string name = heading_of(scene);
  page.footer = provenance_of(scene) + fmt::format(" | minute changes: {} m, {} of speeds and gravity | measures read every {} ms",
                                                   kPerturbedPosition, kPerturbedSpeed, 1e3 * study.interval);
  const Judgement* j = study.find(quantity);
  if (!j) {
    page.title = name + ": nothing to study";
    return page;
  }
  const std::string cost = cost_in_words(study, quantity);
  page.title = fmt::format("{}: {}", words_of(quantity), cost);
  page.title[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(page.title[0])));
  page.subtitle = name;
  page.findings = findings(study, *j);
  page.left = work_precision(study, *j);
  page.right = answer_against_step(study, *j);
  page.bars = uncertainty_bars(study);
  page.table = convergence_table(study, *j);
  return page;
}

}  // namespace cli::study
