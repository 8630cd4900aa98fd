#include "cli/study/words.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace cli::study {
namespace {

double spread_of(const Answer& a) {
  return (a.high - a.low) / 2;
}

/// Cheapest step of the ladder whose answers are no wider than those of the scene's own. Only where each step's own error is known:
/// a range is shared by all steps, and would call the coarsest as good as any.
const SettingResult* cheapest_as_good(const Study& study, const Judgement& j) {
  const SettingResult* own = study.own();
  const Answer* wanted = own ? answer_of(*own, j.quantity) : nullptr;
  const bool each_known = !j.cloud && (j.convergence.trust != Trust::range || j.error_kind == "second_scheme");
  if (!wanted || !each_known) return nullptr;
  const auto width = [](const Answer& a) { return std::max(a.uncertainty, spread_of(a)); };
  const SettingResult* best = own;
  for (const SettingResult& r : study.series.front().settings)
    if (const Answer* a = answer_of(r, j.quantity); a && width(*a) <= 1.1 * width(*wanted) && r.wall_s < best->wall_s) best = &r;
  return best;
}

/// How many times the error at equal computing time when events are not located inside the step; 0 if the study cannot tell.
double worth_of_events(const Study& study, const Judgement& j) {
  const SettingResult* own = study.own();
  const Answer* mine = own ? answer_of(*own, j.quantity) : nullptr;
  const std::string name = study.series.front().series.name + kNotLocated;
  if (!mine || j.cloud || mine->error == 0 || std::abs(mine->error) < j.convergence.band.back()) return 0;
  for (const SeriesResult& s : study.series) {
    if (s.series.name != name) continue;
    for (std::size_t i = 0; i + 1 < s.settings.size(); ++i) {
      const SettingResult &cheap = s.settings[i], &dear = s.settings[i + 1];
      const Answer *a = answer_of(cheap, j.quantity), *b = answer_of(dear, j.quantity);
      if (!a || !b || a->error == 0 || b->error == 0 || cheap.wall_s > own->wall_s || dear.wall_s < own->wall_s) continue;
      const double share = std::log(own->wall_s / cheap.wall_s) / std::log(dear.wall_s / cheap.wall_s);
      return std::pow(std::abs(a->error), 1 - share) * std::pow(std::abs(b->error), share) / std::abs(mine->error);
    }
  }
  return 0;
}

/// How the numerical uncertainty is known.
std::string grounds(const Judgement& j) {
  if (j.convergence.trust == Trust::exact) return "Every step gives this answer.";
  if (j.cloud) return "So far the middle of the answers still moves from this step to finer ones.";
  if (!j.second_scheme.empty() && !j.schemes_agree)
    return fmt::format("A second way of computing, {}, tends to another answer. The range holds both, and no finer claim is made.",
                       j.second_scheme);
  if (j.convergence.trust == Trust::steady)
    return fmt::format(
        "Each halving of the step brings the answer nearer to one value, steadily. "
        "A second way of computing, {}, tends to the same value.",
        j.second_scheme);
  if (j.error_kind == "second_scheme")
    return fmt::format("A second way of computing, {}, settles on one value within that distance.", j.second_scheme);
  return "Answers at finer steps stay within that range. They close in too unevenly to claim less.";
}

/// The first level whose band is half of the own one or less; none: null.
const SettingResult* level_of_half(const SeriesResult& ladder, const Judgement& j, std::size_t own) {
  const Answer* wanted = answer_of(ladder.settings[own], j.quantity);
  for (std::size_t i = own + 1; i < ladder.settings.size(); ++i)
    if (const Answer* a = answer_of(ladder.settings[i], j.quantity); a && a->uncertainty <= wanted->uncertainty / 2)
      return &ladder.settings[i];
  return nullptr;
}

}  // namespace

namespace {

/// Two digits without an exponent: "380", "5.2", "0.12".
std::string short_number(double value) {
  const int power = static_cast<int>(std::floor(std::log10(std::abs(value)) + 1e-12));
  const double unit = std::pow(10.0, power - 1);
  return fmt::format("{:.{}f}", std::round(value / unit) * unit, std::max(0, 1 - power));
}

}  // namespace

std::string with_unit(double value, const std::string& unit) {
  if (value == 0) return fmt::format("0 {}", unit);
  const double size = std::abs(value);
  if (size < 1e-11) return fmt::format("{:.0e} {}", value, unit);
  if (unit == "m" && size < 1e-6) return short_number(1e9 * value) + " nm";
  if (unit == "m" && size < 1e-4) return short_number(1e6 * value) + " \u00b5m";
  if (unit == "m" && size < 0.1) return short_number(1e3 * value) + " mm";
  if (unit == "m/s" && size < 1e-4) return short_number(1e6 * value) + " \u00b5m/s";
  if (unit == "m/s" && size < 0.1) return short_number(1e3 * value) + " mm/s";
  if (unit == "s" && size < 0.1) return short_number(1e3 * value) + " ms";
  return fmt::format("{:.3g} {}", value, unit);
}

namespace {

/// "0.3 s of computing buys ± 0.3 m, 3 s ± 0.1 m.": levels of the scene's own ladder, each twice as sure as the one before,
/// down to what minute changes do. A level that a surer one undercuts is no offer.
std::string price_in_words(const Study& study, const Judgement& j) {
  constexpr std::size_t kMostOffers = 4;
  const std::string unit = unit_of(j.quantity);
  std::vector<const SettingResult*> offers;
  const auto uncertainty = [&](const SettingResult& r) { return answer_of(r, j.quantity)->uncertainty; };
  double floor = 0;
  for (const SettingResult& r : study.series.front().settings) {
    const Answer* a = answer_of(r, j.quantity);
    if (!a || (!offers.empty() && a->uncertainty > uncertainty(*offers.back()) / 2)) continue;
    while (!offers.empty() && offers.back()->wall_s >= r.wall_s) offers.pop_back();
    if (offers.size() == kMostOffers) offers.pop_back();
    offers.push_back(&r);
    if (a->uncertainty <= spread_of(*a)) {
      floor = spread_of(*a);
      break;
    }
  }
  std::string out;
  for (const SettingResult* r : offers)
    out += fmt::format("{}{}{} \u00b1 {}", out.empty() ? "" : ", ", with_unit(r->wall_s, "s"),
                       out.empty() ? " of computing buys" : "", with_unit(uncertainty(*r), unit));
  out += ".";
  if (floor > 0) out += fmt::format(" More buys nothing: minute changes move it by \u00b1 {}.", with_unit(floor, unit));
  return out;
}

/// What the answer hangs on, and by how much.
struct Share {
  double width = 0;
  std::string source;
};

/// Of the scene as it stands, the largest first.
std::vector<Share> shares_of(const Study& study, const Judgement& j, const Answer& own) {
  std::vector<Share> shares{{own.uncertainty, "numerics"}, {spread_of(own), "minute changes"}};
  for (const InputRange& input : study.inputs)
    if (const auto found = input.half_width.find(j.quantity); found != input.half_width.end())
      shares.push_back({found->second, fmt::format("{} from {} to {}", input.key, input.low, input.high)});
  std::stable_sort(shares.begin(), shares.end(), [](const Share& a, const Share& b) { return a.width > b.width; });
  return shares;
}

/// Two shares a sentence.
std::string shares_in_words(const std::vector<Share>& shares, const std::string& unit, bool inputs_given) {
  std::string out;
  for (std::size_t i = 0; i < shares.size(); ++i)
    out += fmt::format("{}{} \u00b1 {}",
                       i == 0       ? "Largest share first: "
                       : i % 2 == 0 ? ". Then "
                                    : ", ",
                       shares[i].source, with_unit(shares[i].width, unit));
  return out + (inputs_given ? ". Contact law and other assumptions are not counted."
                             : ". Neither uncertain inputs (--input) nor contact law and other assumptions are counted.");
}

/// Whether a better answer is worth its time: not where something else than numerics decides.
std::string worth_in_words(const Study& study, const Judgement& j, const Share& largest) {
  const SettingResult* own = study.own();
  const double mine = answer_of(*own, j.quantity)->uncertainty;
  const std::string unit = unit_of(j.quantity);
  if (j.convergence.trust == Trust::exact && j.besides.empty())
    return "A finer step is not worth its time: it gives the same answer.";
  if (largest.source != "numerics")
    return fmt::format("A finer step leaves \u00b1 {} from {}.", with_unit(largest.width, unit), largest.source);
  const SettingResult* better = nullptr;
  for (const SettingResult& r : study.series.front().settings)
    if (const Answer* a = answer_of(r, j.quantity); a && a->uncertainty <= mine / 2 && (!better || r.wall_s < better->wall_s))
      better = &r;
  if (!better) return fmt::format("A finer step is not worth its time: none buys half of \u00b1 {}.", with_unit(mine, unit));
  return fmt::format("A better answer is worth it where \u00b1 {} is too much: {} buys \u00b1 {}.", with_unit(mine, unit),
                     with_unit(better->wall_s, "s"), with_unit(answer_of(*better, j.quantity)->uncertainty, unit));
}

/// What nobody can measure, and what it does to the answer.
std::string minute_in_words(const Study& study, const Judgement& j, double spread) {
  const std::string unit = unit_of(j.quantity), moved = with_unit(spread, unit);
  if (!j.cloud) return fmt::format("They move it by \u00b1 {}: the answer does not hang on such details.", moved);
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const SettingResult& r : study.series.front().settings)
    if (const Answer* a = answer_of(r, j.quantity)) {
      low = std::min({low, a->low, a->value});
      high = std::max({high, a->high, a->value});
    }
  return fmt::format(
      "They move it by \u00b1 {}, and no computer and no step takes this away. "
      "With them all steps lie between {:.4g} and {:.4g} {}: quote that range.",
      moved, low, high, unit);
}

}  // namespace

std::string provenance_of(const scenes::Scene& scene) {
  std::string warnings;
  for (const std::string& warning : scene.stage.warnings) warnings += "Warning: " + warning + " | ";
  return warnings + fmt::format("crashreel {}, {} | {} | scene SHA-256 {}{}{} | times: computing on one core, warm, median",
                                CRASHREEL_VERSION, CRASHREEL_BUILD, scene.path.filename().string(), scene.sha256.substr(0, 16),
                                scene.overrides.empty() ? "" : " with ", fmt::join(scene.overrides, ", "));
}

std::string with_digits(double value, double uncertainty) {
  const double ratio = uncertainty > 0 && value != 0 ? std::abs(value) / uncertainty : 1e9;
  return fmt::format("{:.{}g}", value, std::clamp(static_cast<int>(std::ceil(std::log10(ratio))) + 2, 4, 10));
}

std::string cost_in_words(const Study& study, const std::string& quantity) {
  const Judgement* j = study.find(quantity);
  const SeriesResult& ladder = study.series.front();
  std::size_t own = 0;
  while (own < ladder.settings.size() && !ladder.settings[own].setting.own) ++own;
  const Answer* a = j && own < ladder.settings.size() ? answer_of(ladder.settings[own], quantity) : nullptr;
  if (!a) return "the scene's own settings do not define an answer";
  const std::string unit = unit_of(quantity);
  if (j->convergence.trust == Trust::exact && j->besides.empty())
    return "every step gives the same answer; a finer one costs time for nothing";
  if (j->cloud && spread_of(*a) > a->uncertainty)
    return fmt::format("no time buys less than \u00b1 {}: minute changes move the answer that far", with_unit(spread_of(*a), unit));
  const char* width = j->convergence.trust == Trust::steady ? "band" : "range";
  if (const SettingResult* half = level_of_half(ladder, *j, own))
    return fmt::format("a {} of \u00b1 {} in place of \u00b1 {} costs {:.1f} times the time", width,
                       with_unit(answer_of(*half, quantity)->uncertainty, unit), with_unit(a->uncertainty, unit),
                       half->wall_s / ladder.settings[own].wall_s);
  if (j->beside_the_step() > a->uncertainty / 2)
    return fmt::format("\u00b1 {}, limited by {}, not by the step", with_unit(a->uncertainty, unit), j->besides.front().source);
  return fmt::format("\u00b1 {}; no finer step that was tried halves this", with_unit(a->uncertainty, unit));
}

std::vector<std::string> findings(const Study& study, const Judgement& j) {
  const SettingResult* own = study.own();
  const Answer* a = own ? answer_of(*own, j.quantity) : nullptr;
  if (!a) return {};
  const std::string unit = unit_of(j.quantity), words = words_of(j.quantity);
  const double spread = spread_of(*a);
  const std::vector<Share> shares = shares_of(study, j, *a);
  std::vector<std::string> out{price_in_words(study, j) + " " + worth_in_words(study, j, shares.front()),
                               shares_in_words(shares, unit, !study.inputs.empty())};
  for (std::string& notice : in_words(study.notices)) out.push_back(std::move(notice));
  out.push_back(fmt::format("The scene as it stands gives a {} of {} {}, \u00b1 {}. That is {}, and takes {}. {}", words,
                            with_digits(a->value, a->uncertainty), unit, with_unit(a->uncertainty, unit), own->setting.label,
                            with_unit(own->wall_s, "s"), grounds(j)));
  if (j.error_kind == "closed_form")
    out.push_back(fmt::format("A formula gives {:.8g} {} exactly: this run is off by {}.", j.reference, unit,
                              with_unit(std::abs(a->error), unit)));
  out.push_back("Minute changes are a thousandth of a millimetre and a millionth of a speed. " + minute_in_words(study, j, spread));
  if (const double worth = worth_of_events(study, j); worth >= 2)
    out.push_back(fmt::format("Events placed inside their step leave {:.0f} times less error in the same time.",
                              worth < 100 ? worth : std::round(worth / 100) * 100));
  if (const SettingResult* cheap = cheapest_as_good(study, j); cheap && cheap != own)
    out.push_back(fmt::format("The setting \"{}\" does as well in {} instead of {}.", cheap->setting.label,
                              with_unit(cheap->wall_s, "s"), with_unit(own->wall_s, "s")));
  out.push_back(
      "This page tells how well the scene was computed. Whether its speeds, masses and frictions are right is another question.");
  return out;
}

}  // namespace cli::study
