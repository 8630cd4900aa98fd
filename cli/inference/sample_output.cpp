// A sample in words, as JSON and as a page for print.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "cli/inference/sample.h"
#include "cli/output/json.h"
#include "cli/scene_run.h"
#include "cli/study/quantities.h"

namespace cli::inference {
namespace {

namespace charts = render::charts;

constexpr double kTold = 1e-5;  // in the unit of a measure: what varies less is the arithmetic's

Json share_json(const Share& s) {
  return {{"value", s.value}, {"low", s.low}, {"high", s.high}};
}

Json output_json(const Prior& prior, const Output& o) {
  Json out = {{"runs", o.runs}, {"mean", number_json(o.mean)}, {"sd", number_json(o.sd)}};
  for (const Percentile& p : o.percentiles)
    out["percentiles"][fmt::format("p{}", 100 * p.share)] = {
        {"value", number_json(p.value)}, {"low", number_json(p.low)}, {"high", number_json(p.high)}};
  if (o.sensitivity.runs == 0) return out;
  for (std::size_t i = 0; i < prior.inputs().size(); ++i)
    out["sensitivity"][prior.inputs()[i].key] = {{"first", share_json(o.sensitivity.first[i])},
                                                 {"total", share_json(o.sensitivity.total[i])}};
  out["scatter"] = share_json(o.sensitivity.scatter);
  out["degree"] = o.sensitivity.degree;
  return out;
}

std::string label(const std::string& output) {
  const std::string unit = study::unit_of(output);
  return study::words_of(output) + (unit.empty() ? "" : " [" + unit + "]");
}

std::string percent(const Share& s) {
  return fmt::format("{:.0f} ({:.0f}..{:.0f}) %", 100 * s.value, 100 * s.low, 100 * s.high);
}

const Output* find(const Sample& sample, const std::string& name) {
  for (const Output& o : sample.outputs)
    if (o.name == name) return &o;
  return nullptr;
}

/// Which input explains most of an output.
std::size_t strongest(const Output& o) {
  std::size_t best = 0;
  for (std::size_t i = 1; i < o.sensitivity.total.size(); ++i)
    if (o.sensitivity.total[i].value > o.sensitivity.total[best].value) best = i;
  return best;
}

charts::Chart distribution(const Sample& sample, const Output& o) {
  charts::Chart chart;
  chart.title = fmt::format("Distribution of the {}", study::words_of(o.name));
  chart.x_label = label(o.name);
  chart.y_label = "share of the runs below [%]";
  std::vector<double> values;
  for (const double x : column(sample.table, o.name))
    if (std::isfinite(x)) values.push_back(x);
  std::sort(values.begin(), values.end());
  charts::Line line{"share of runs", {}, true, true, 0};
  const auto n = static_cast<double>(values.size());
  for (std::size_t i = 0; i < values.size(); ++i)
    line.points.push_back({values[i], 100 * (static_cast<double>(i) + 0.5) / n, 0, 0});
  chart.lines.push_back(std::move(line));
  charts::Line ends{"5th, 50th, 95th percentile", {}, false, false, 1};
  for (const Percentile& p : o.percentiles)
    if (p.share == 0.05 || p.share == 0.5 || p.share == 0.95) ends.points.push_back({p.value, 100 * p.share, 0, 0});
  chart.lines.push_back(std::move(ends));
  return chart;
}

charts::Chart scatter(const Prior& prior, const Sample& sample, const Output& o) {
  charts::Chart chart;
  const std::size_t input = strongest(o);
  const scenes::Uncertain& u = prior.inputs()[input];
  chart.title = fmt::format("Each run: {} against {}", study::words_of(o.name), u.key);
  chart.x_label = fmt::format("{}{}", u.key, u.unit.name.empty() ? "" : " [" + u.unit.name + "]");
  chart.y_label = label(o.name);
  charts::Line cloud{"runs", {}, false, false, 0.4};
  const std::vector<double> y = column(sample.table, o.name);
  for (std::size_t r = 0; r < y.size(); ++r)
    if (std::isfinite(y[r]) && !sample.table.rows[r].values.empty())
      cloud.points.push_back({sample.table.rows[r].values[input] / u.unit.factor, y[r], 0, 0});
  chart.lines.push_back(std::move(cloud));
  return chart;
}

charts::Bars tornado(const Prior& prior, const Output& o) {
  charts::Bars bars;
  bars.title = fmt::format("What the {} hangs on: share of its variance, with 90 % range", study::words_of(o.name));
  bars.parts = {"alone", "with others"};
  std::vector<std::size_t> order(prior.inputs().size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  const Sensitivity& s = o.sensitivity;
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return s.total[a].value > s.total[b].value; });
  for (const std::size_t i : order)
    bars.rows.push_back({prior.inputs()[i].key,
                         {s.first[i].value, std::max(0.0, s.total[i].value - s.first[i].value)},
                         {percent(s.first[i]), fmt::format("total {}", percent(s.total[i]))}});
  bars.rows.push_back({"no smooth law of the inputs", {s.scatter.value, 0}, {percent(s.scatter), ""}});
  return bars;
}

std::string value_text(double x, double resolution) {
  return std::isfinite(x) ? told(x, {}, resolution) : "outside";
}

/// What a screen of results shows, the measure of the charts first; the others stand in sample.json.
std::vector<const Output*> told_outputs(const Sample& sample) {
  std::vector<const Output*> out;
  for (const Output& o : sample.outputs) {
    const bool shown = study::is_on_screen(o.name) || o.name == sample.main;
    if (o.sd > kTold && !study::is_defect(o.name) && shown) out.push_back(&o);
  }
  std::stable_partition(out.begin(), out.end(), [&sample](const Output* o) { return o->name == sample.main; });
  return out;
}

charts::Table percentiles(const Sample& sample) {
  charts::Table table;
  table.title = "Percentiles; in brackets the 95 % range of the percentile itself, from the number of runs";
  table.head = {"measure", "runs", "5 %", "50 %", "95 %"};
  for (const Output* o : told_outputs(sample)) {
    std::vector<std::string> row{label(o->name), fmt::format("{}", o->runs)};
    for (const double share : {0.05, 0.5, 0.95})
      for (const Percentile& p : o->percentiles)
        if (p.share == share)
          row.push_back(fmt::format("{} ({}..{})", value_text(p.value, o->sd / 30), value_text(p.low, o->sd / 30),
                                    value_text(p.high, o->sd / 30)));
    if (o->name == sample.main) table.emphasised = static_cast<int>(table.rows.size());
    table.rows.push_back(std::move(row));
  }
  return table;
}

std::string number_text(double x, double resolution) {
  return std::isfinite(x) ? told(x, {}, resolution) : "none";
}

/// A row a run: what was chosen, then measures, that of the charts first, as many as a screen is wide.
charts::Table chosen_runs(const Sample& sample) {
  constexpr std::size_t kScreen = 100;
  charts::Table table;
  table.title = "Every run; all measures stand in runs.csv";
  table.head = sample.table.grid_keys;
  for (const Row& row : sample.table.rows) table.rows.push_back(row.grid);
  std::size_t wide = 0;
  for (const std::string& key : table.head) wide += key.size() + 2;
  for (const Output* o : told_outputs(sample)) {
    wide += label(o->name).size() + 2;
    if (wide > kScreen && table.head.size() > sample.table.grid_keys.size()) break;
    table.head.push_back(label(o->name));
    const std::vector<double> values = column(sample.table, o->name);
    for (std::size_t r = 0; r < values.size(); ++r) table.rows[r].push_back(number_text(values[r], o->sd / 30));
  }
  return table;
}

/// Of one key with numbers: the measure over it.
charts::Chart over_chosen(const Sample& sample, const Output& o) {
  charts::Chart chart;
  charts::Line line{"runs", {}, true, true, 0.6};
  const std::vector<double> y = column(sample.table, o.name);
  if (sample.table.grid_keys.size() != 1) return chart;
  for (std::size_t r = 0; r < y.size(); ++r) {
    const std::string& text = sample.table.rows[r].grid.front();
    char* end = nullptr;
    const double x = std::strtod(text.c_str(), &end);
    const std::string unit = *end == ' ' ? end + 1 : end;
    if (end == text.c_str() || unit.find_first_of("-0123456789") == 0) return chart;  // a word, or several numbers
    if (std::isfinite(y[r])) line.points.push_back({x, y[r], 0, 0});
    chart.x_label = sample.table.grid_keys.front() + (unit.empty() ? "" : " [" + unit + "]");
  }
  chart.title = fmt::format("The {} at each value", study::words_of(o.name));
  chart.y_label = label(o.name);
  chart.lines.push_back(std::move(line));
  return chart;
}

std::string in_columns(const charts::Table& table) {
  std::vector<std::size_t> width;
  for (const std::string& head : table.head) width.push_back(head.size());
  for (const auto& row : table.rows)
    for (std::size_t k = 0; k < row.size(); ++k) width[k] = std::max(width[k], row[k].size());
  std::string out;
  const auto add = [&](const std::vector<std::string>& row) {
    for (std::size_t k = 0; k < row.size(); ++k) out += fmt::format("  {:>{}}", row[k], width[k]);
    out += "\n";
  };
  add(table.head);
  for (const auto& row : table.rows) add(row);
  return out;
}

std::vector<std::string> findings(const Prior& prior, const Sample& sample, const Output* main) {
  std::vector<std::string> out = in_words(notices_of(sample.table));
  if (main && main->runs > 0 && is_chosen(sample.table)) {
    std::vector<double> values = column(sample.table, main->name);
    std::erase_if(values, [](double v) { return !std::isfinite(v); });
    const auto [least, most] = std::minmax_element(values.begin(), values.end());
    out.push_back(
        fmt::format("Over the values given the {} lies between {} and {} {}. They were chosen, not drawn: no share of the "
                    "runs is a probability.",
                    study::words_of(main->name), number_text(*least, main->sd / 30), number_text(*most, main->sd / 30),
                    study::unit_of(main->name)));
  } else if (main && main->runs > 0) {
    const auto at = [&](double share) {
      for (const Percentile& p : main->percentiles)
        if (p.share == share) return value_text(p.value, main->sd / 30);
      return std::string();
    };
    out.push_back(fmt::format("In 95 of 100 runs the {} lies between {} and {} {}; the middle one is {} {}.",
                              study::words_of(main->name), at(0.025), at(0.975), study::unit_of(main->name), at(0.5),
                              study::unit_of(main->name)));
    if (main->sensitivity.runs > 0) {
      const std::size_t i = strongest(*main);
      out.push_back(
          fmt::format("Most of its variance comes from {}: {} with its interplay with others; {} follows from no smooth law of the "
                      "inputs (near starts that end far apart, jumps).",
                      prior.inputs()[i].key, percent(main->sensitivity.total[i]), percent(main->sensitivity.scatter)));
    }
  }
  std::string assumed;
  for (const auto& u : prior.inputs()) assumed += fmt::format("{}{} {}", assumed.empty() ? "" : "; ", u.key, in_words(u));
  if (!assumed.empty()) out.push_back("Assumed: " + assumed + ".");
  if (prior.correlated()) out.push_back("Correlated inputs: each one's share is what it adds to those named before it.");
  int failed = 0;
  for (const auto& [reason, count] : sample.failures) failed += count;
  if (failed > 0)
    out.push_back(fmt::format("{} of {} runs gave no answer and are left out of every figure here; the commonest reason: {}.",
                              failed, sample.table.rows.size(), sample.failures.front().first));
  return out;
}

}  // namespace

std::string in_words(const scenes::Uncertain& u) {
  const std::string unit = u.unit.name.empty() ? "" : " " + u.unit.name;
  const std::vector<double>& n = u.numbers;
  std::string out;
  switch (u.spread) {
    case scenes::Spread::uniform:
      out = fmt::format("uniform {:g} to {:g}{}", n[0] / u.unit.factor, n[1] / u.unit.factor, unit);
      break;
    case scenes::Spread::normal:
      out = fmt::format("normal {:g}{} with standard deviation {:g}{}", n[0] / u.unit.factor, unit, n[1] / u.unit.factor, unit);
      break;
    case scenes::Spread::triangular:
      out = fmt::format("triangular {:g}, {:g}, {:g}{}", n[0] / u.unit.factor, n[1] / u.unit.factor, n[2] / u.unit.factor, unit);
      break;
    case scenes::Spread::log_normal:
      out = fmt::format("log-normal {:g}{} times or by {:g}", n[0] / u.unit.factor, unit, n[1]);
      break;
    case scenes::Spread::choice:
      out = fmt::format("one of {}", fmt::join(u.choices, ", "));
      break;
    case scenes::Spread::table:
      out = fmt::format("by table {:g} to {:g}{}", n.front() / u.unit.factor, n.back() / u.unit.factor, unit);
      break;
  }
  if (std::isfinite(u.lower)) out += fmt::format(" within {:g} to {:g}{}", u.lower / u.unit.factor, u.upper / u.unit.factor, unit);
  return out;
}

nlohmann::ordered_json sample_json(const scenes::Scene& scene, const Prior& prior, const Sample& sample) {
  Json out = {{"schema", 1}, {"version", CRASHREEL_VERSION}};
  out["scene"] = {{"title", scene.title}, {"path", scene.path.string()}, {"sha256", scene.sha256}, {"overrides", scene.overrides}};
  out["seed"] = sample.seed;
  out["runs"] = sample.table.rows.size();
  out["failed"] = Json::array();
  for (const auto& [reason, count] : sample.failures) out["failed"].push_back({{"reason", reason}, {"runs", count}});
  add_notices(notices_of(sample.table), out);
  out["inputs"] = Json::object();
  for (const auto& u : prior.inputs()) out["inputs"][u.key] = {{"unit", u.si_unit}, {"prior", in_words(u)}};
  out["outputs"] = Json::object();
  for (const Output& o : sample.outputs) out["outputs"][o.name] = output_json(prior, o);
  return out;
}

std::string sample_text(const scenes::Scene& scene, const Prior& prior, const Sample& sample) {
  std::string out = heading_of(scene) + "\n";
  for (const std::string& line : findings(prior, sample, find(sample, sample.main))) out += "  " + line + "\n";
  if (is_chosen(sample.table)) return out + in_columns(chosen_runs(sample));
  for (const std::vector<std::string>& row : percentiles(sample).rows)
    out += fmt::format("  {:<32} {:>6} runs   5 %: {}   50 %: {}   95 %: {}\n", row[0], row[1], row[2], row[3], row[4]);
  return out + "  every measure: sample.json; every run: runs.csv\n";
}

render::charts::Page sample_page(const scenes::Scene& scene, const Prior& prior, const Sample& sample) {
  charts::Page page;
  page.footer = fmt::format("crashreel {} | {} | scene SHA-256 {} | {} runs, seed {}", CRASHREEL_VERSION,
                            scene.path.filename().string(), scene.sha256.substr(0, 16), sample.table.rows.size(), sample.seed);
  page.title = (is_chosen(sample.table) ? "What follows from each value: " : "What is not known of it, and what follows: ") +
               heading_of(scene);
  page.subtitle = fmt::format("{} runs over {} (crashreel sample)", sample.table.rows.size(),
                              is_chosen(sample.table) ? "the values given" : "what the scene leaves open");
  const Output* main = find(sample, sample.main);
  page.findings = findings(prior, sample, main);
  if (main) page.left = is_chosen(sample.table) ? over_chosen(sample, *main) : distribution(sample, *main);
  if (main && main->sensitivity.runs > 0) {
    page.right = scatter(prior, sample, *main);
    page.bars = tornado(prior, *main);
  }
  page.table = is_chosen(sample.table) ? chosen_runs(sample) : percentiles(sample);
  return page;
}

}  // namespace cli::inference
