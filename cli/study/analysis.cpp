#include "cli/study/analysis.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "cli/study/perturb.h"
#include "cli/study/statistics.h"
#include "engine/measure/definitions.h"

namespace cli::study {
namespace {

/// The ensemble is changed by a millionth: an outcome that answers with more than this share has amplified it a thousandfold.
constexpr double kCloud = 1e-3;

const Quantity* find_quantity(const Outcome& outcome, const std::string& name) {
  for (const Quantity& q : outcome.quantities)
    if (q.name == name) return &q;
  return nullptr;
}

/// Spread of the ensembles of the ladder, against the size of the answer.
bool is_cloud(const SeriesResult& ladder, const std::string& quantity) {
  std::vector<double> shares;
  for (const SettingResult& result : ladder.settings)
    if (const Answer* a = answer_of(result, quantity); a && result.setting.members > 0)
      shares.push_back((a->high - a->low) / std::max(std::abs(a->middle), 1e-9));
  return !shares.empty() && median(shares) > kCloud;
}

/// The levels of a ladder that have the quantity; `at` gets their places in it.
std::vector<Level> levels_of(const SeriesResult& ladder, const std::string& quantity, bool cloud, std::vector<std::size_t>& at) {
  std::vector<Level> out;
  const std::vector<std::string>& finest = ladder.settings.back().contacts;
  for (std::size_t i = 0; i < ladder.settings.size(); ++i) {
    const SettingResult& result = ladder.settings[i];
    const Answer* a = answer_of(result, quantity);
    if (!a || !std::isfinite(a->value)) continue;
    out.push_back({result.setting.fineness, cloud ? a->middle : a->value, !cloud && result.contacts == finest});
    at.push_back(i);
  }
  return out;
}

/// Where the spread swamps what the step does, the middle of all answers of the three finest levels is the reference.
double median_of_finest(const std::vector<Level>& levels) {
  std::vector<double> finest;
  for (std::size_t i = levels.size() > 3 ? levels.size() - 3 : 0; i < levels.size(); ++i) finest.push_back(levels[i].value);
  return median(finest);
}

/// The limit another scheme tends to, and how far that may be off.
struct SecondOpinion {
  std::string scheme;
  double limit = 0, band = 0;
  bool range = false;
  double beyond = 0;
};

/// Of the other schemes that take another way to the answer, the one that is surest of it. One whose finest run is that of the
/// scene's own to the last digit has computed the same thing again: it is no second opinion.
std::optional<SecondOpinion> second_opinion(const Study& study, const Judgement& judgement, double own_finest) {
  std::optional<SecondOpinion> out;
  for (std::size_t s = 1; s < study.series.size(); ++s) {
    const SeriesResult& other = study.series[s];
    if (!other.series.steps) continue;
    std::vector<std::size_t> at;
    const std::vector<Level> levels = levels_of(other, judgement.quantity, judgement.cloud, at);
    if (levels.size() < 2 || (levels.back().value == own_finest && judgement.convergence.trust != Trust::exact)) continue;
    const Convergence c = converge(levels);
    if (!out || c.band.back() < out->band)
      out = SecondOpinion{other.series.name, c.limit, c.band.back(), c.trust == Trust::range, c.beyond};
  }
  return out;
}

/// Two schemes must tend to one answer before a band is printed. Where the other one is surer, its limit is the reference.
void ask_second_scheme(const Study& study, Judgement& judgement, const std::vector<Level>& levels) {
  Convergence& c = judgement.convergence;
  const auto second = second_opinion(study, judgement, levels.back().value);
  if (!second) {
    if (c.trust == Trust::steady) c = range_only(levels);
    return;
  }
  judgement.second_scheme = second->scheme;
  const double apart = std::abs(c.limit - second->limit);
  judgement.schemes_agree = apart <= c.band.back() + second->band;
  if (!judgement.schemes_agree || (c.trust == Trust::range && second->range)) {
    // they tend to different answers, or neither closes in on one: the range holds what both say
    c.trust = Trust::range;
    for (std::size_t i = 0; i < levels.size(); ++i)
      c.band[i] = std::max(c.band[i], std::abs(levels[i].value - second->limit) + (second->range ? second->beyond : second->band));
  } else if (c.trust == Trust::range && second->band < c.band.back()) {
    judgement.error_kind = "second_scheme";
    c.limit = second->limit;
    double largest = 0;
    for (std::size_t i = levels.size(); i-- > 0;) {
      c.error[i] = levels[i].value - c.limit;
      largest = std::max(largest, std::abs(c.error[i]));
      c.band[i] = kSafety * largest + second->band;
    }
  }
}

/// Where the spread swamps what the step does, medians settle the width; but what is printed is the scene's own answer, and its
/// range holds those of this and finer steps too.
void hold_own_answers(const SeriesResult& ladder, Judgement& judgement, const std::vector<std::size_t>& at) {
  const auto own = [&](std::size_t k) { return ladder.settings[at[k]].answers.at(judgement.quantity).value; };
  const std::size_t n = at.size(), third = n > 3 ? n - 3 : 0;
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t k = std::min(i, third); k < n; ++k)
      judgement.convergence.band[i] = std::max(judgement.convergence.band[i], std::abs(own(k) - own(i)));
}

void settle_reference(Judgement& judgement, const std::vector<Level>& levels, const std::map<std::string, double>& closed_form) {
  const Convergence& c = judgement.convergence;
  judgement.reference = c.limit;
  if (judgement.error_kind.empty()) judgement.error_kind = c.trust == Trust::steady ? "richardson" : "finest";
  if (judgement.cloud) {
    judgement.reference = median_of_finest(levels);
    judgement.error_kind = "median";
  }
  if (is_defect(judgement.quantity)) {
    judgement.reference = 0;
    judgement.error_kind = "exact_zero";
  }
  if (const auto known = closed_form.find(judgement.quantity); known != closed_form.end()) {
    judgement.reference = known->second;
    judgement.error_kind = "closed_form";
  }
}

/// What the settings besides the step leave open: twice the change when the solver is asked for more, when more instants are
/// recorded; twice, for the finest of them is not the last word.
std::vector<Besides> besides_the_step(const Study& study, const std::string& quantity) {
  std::vector<Besides> out;
  for (const SeriesResult& series : study.series) {
    if (series.series.own_fineness <= 0) continue;
    const Answer* finest = answer_of(series.settings.back(), quantity);
    double most = 0;
    for (const SettingResult& result : series.settings)
      if (const Answer* a = answer_of(result, quantity);
          a && finest && result.setting.fineness <= 1.0001 * series.series.own_fineness)
        most = std::max(most, 2 * std::abs(a->value - finest->value));
    if (most > 0) out.push_back({series.series.meaning, most});
  }
  // a start lies on a grid of 15 nm (engine/local_frame.h): a blow aslant carries that on some tenfold
  constexpr double kGrid = 1.5e-7;
  const std::string unit = unit_of(quantity);
  if (study.rigid_contacts && (unit == "m" || unit == "s" || unit == "m/s"))
    out.push_back({"the grid that the start lies on", kGrid});
  std::stable_sort(out.begin(), out.end(), [](const Besides& a, const Besides& b) { return a.width > b.width; });
  return out;
}

/// Errors of every series against the reference. Off the ladder the uncertainty is the error itself and what the reference lacks.
void fill_errors(Study& study, const Judgement& judgement, const std::vector<std::size_t>& at) {
  const double reference_band = judgement.convergence.band.back();
  for (std::size_t s = 0; s < study.series.size(); ++s)
    for (SettingResult& result : study.series[s].settings) {
      const auto found = result.answers.find(judgement.quantity);
      if (found == result.answers.end()) continue;
      Answer& a = found->second;
      a.error = (judgement.cloud && result.setting.members > 0 ? a.middle : a.value) - judgement.reference;
      a.uncertainty = std::abs(a.error) + judgement.beside_the_step() +
                      (judgement.error_kind == "closed_form" || judgement.error_kind == "exact_zero" ? 0 : reference_band);
    }
  for (std::size_t i = 0; i < at.size(); ++i) {
    Answer& a = study.series[0].settings[at[i]].answers[judgement.quantity];
    a.uncertainty = is_defect(judgement.quantity) ? std::abs(a.value) : judgement.convergence.band[i] + judgement.beside_the_step();
  }
  for (SeriesResult& series : study.series)
    for (SettingResult& result : series.settings)
      if (const auto found = result.answers.find(judgement.quantity); found != result.answers.end())
        found->second.uncertainty = std::min(found->second.uncertainty, widest_error(judgement.quantity, found->second.value));
}

}  // namespace

const Answer* answer_of(const SettingResult& result, const std::string& quantity) {
  const auto found = result.answers.find(quantity);
  return found != result.answers.end() && result.failure.empty() ? &found->second : nullptr;
}

const Judgement* Study::find(const std::string& quantity) const {
  for (const Judgement& j : judgements)
    if (j.quantity == quantity) return &j;
  return nullptr;
}

const SettingResult* Study::own() const {
  for (const SeriesResult& s : series)
    for (const SettingResult& result : s.settings)
      if (result.setting.own) return &result;
  return nullptr;
}

double Judgement::beside_the_step() const {
  double sum = 0;
  for (const Besides& b : besides) sum += b.width;
  return sum;
}

double Study::input_uncertainty(const std::string& quantity) const {
  double sum = 0;
  for (const InputRange& input : inputs)
    if (const auto found = input.half_width.find(quantity); found != input.half_width.end()) sum += found->second * found->second;
  return std::sqrt(sum);
}

SettingResult summarise(const Setting& setting, const std::vector<Outcome>& outcomes) {
  SettingResult out;
  out.setting = setting;
  const Outcome& plain = outcomes.front();
  std::vector<double> walls;
  for (const Outcome& outcome : outcomes) walls.insert(walls.end(), outcome.wall_s.begin(), outcome.wall_s.end());
  out.wall_s = median(walls);
  out.wall_low = percentile(walls, 0.25);
  out.wall_high = percentile(walls, 0.75);
  out.repetitions = static_cast<int>(walls.size());
  out.instructions = plain.instructions;
  out.steps = plain.steps;
  out.end_s = plain.end_s;
  out.contacts = plain.contacts;
  out.failure = plain.failure;
  out.recording = plain.recording;
  for (const Quantity& q : plain.quantities) {
    std::vector<double> sample;
    for (const Outcome& outcome : outcomes)
      if (const Quantity* found = find_quantity(outcome, q.name); found && outcome.failure.empty())
        sample.push_back(engine::turned_to(q.name, found->value, q.value));
    if (sample.empty()) sample.push_back(q.value);
    out.answers[q.name] = {true, q.value, percentile(sample, 0.05), percentile(sample, 0.95), median(sample), 0, 0};
  }
  return out;
}

namespace {

/// Directions of all settings within half a turn of those of the first.
void turn_together(Study& study) {
  if (study.series.front().settings.empty()) return;
  const std::map<std::string, Answer> first = study.series.front().settings.front().answers;
  for (SeriesResult& series : study.series)
    for (SettingResult& setting : series.settings)
      for (auto& [name, answer] : setting.answers) {
        const auto other = first.find(name);
        if (other == first.end()) continue;
        const double turned = engine::turned_to(name, answer.value, other->second.value) - answer.value;
        if (!(std::abs(turned) > 0)) continue;
        for (double* of : {&answer.value, &answer.low, &answer.high, &answer.middle}) *of += turned;
      }
}

}  // namespace

void judge(Study& study, const std::map<std::string, double>& closed_form) {
  turn_together(study);
  const SeriesResult& ladder = study.series.front();
  std::vector<std::string> names;
  for (auto result = ladder.settings.rbegin(); result != ladder.settings.rend(); ++result)
    for (const auto& [name, answer] : result->answers)
      if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
  std::stable_partition(names.begin(), names.end(), [](const std::string& name) { return !is_defect(name); });
  for (const std::string& name : names) {
    Judgement judgement;
    judgement.quantity = name;
    judgement.cloud = !is_defect(name) && is_cloud(ladder, name);
    std::vector<std::size_t> at;
    const std::vector<Level> levels = levels_of(ladder, name, judgement.cloud, at);
    if (levels.size() < 2) continue;
    judgement.convergence = converge(levels);
    ask_second_scheme(study, judgement, levels);
    if (judgement.cloud) hold_own_answers(ladder, judgement, at);
    for (std::size_t i = 0; i < levels.size(); ++i)
      judgement.convergence.band[i] = std::min(judgement.convergence.band[i], widest_error(name, levels[i].value));
    if (!judgement.cloud && !is_defect(name)) judgement.besides = besides_the_step(study, name);
    settle_reference(judgement, levels, closed_form);
    fill_errors(study, judgement, at);
    study.judgements.push_back(std::move(judgement));
  }
}

std::string main_of(const std::vector<std::string>& quantities) {
  constexpr const char* kWishes[] = {"throw_distance_m",      "delta_v_mps", "rebound_height_m",
                                     "head_impact_speed_mps", "travel_m",    "turned_deg"};
  for (const char* wish : kWishes)
    for (const std::string& quantity : quantities)
      if (quantity.starts_with(wish)) return quantity;
  return quantities.empty() ? "" : quantities.front();
}

std::string main_quantity(const Study& study) {
  std::vector<std::string> all, known;
  for (const Judgement& j : study.judgements) {
    all.push_back(j.quantity);
    if (j.error_kind == "closed_form") known.push_back(j.quantity);
  }
  return main_of(known.empty() ? all : known);
}

}  // namespace cli::study
