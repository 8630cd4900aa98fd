// Outcomes -> what they say: errors against a reference, orders and bands, spread of the ensemble, cost.
#pragma once

#include <map>
#include <set>
#include <string>
#include <vector>

#include "cli/output/notices.h"
#include "cli/study/convergence.h"
#include "cli/study/series.h"
#include "cli/study/trial.h"

namespace cli::study {

/// One quantity at one setting.
struct Answer {
  bool present = false;      // the run defines it
  double value = 0;          // of the plain run
  double low = 0, high = 0;  // 5th and 95th percentile of the ensemble, the plain run included
  double middle = 0;         // its median
  double error = 0;          // value (in a cloud: median) - reference
  double uncertainty = 0;    // numerical: half width around the answer that covers the reference
};

struct SettingResult {
  Setting setting;
  double wall_s = 0, wall_low = 0, wall_high = 0;  // median, quartiles
  int repetitions = 0;
  double instructions = 0;
  long steps = 0;
  double end_s = 0;
  std::vector<std::string> contacts;
  std::string failure;
  std::string recording;  // hash of the plain run
  std::map<std::string, Answer> answers;
};

/// Null if the run diverged or does not define it.
const Answer* answer_of(const SettingResult&, const std::string& quantity);

struct SeriesResult {
  Series series;
  std::vector<SettingResult> settings;
};

/// What something besides the step leaves open.
struct Besides {
  std::string source;  // for the reader: "how often the motion is recorded"
  double width = 0;    // half, in the unit of the quantity
};

/// How one quantity is judged.
struct Judgement {
  std::string quantity;
  std::string error_kind;  // closed_form, exact_zero, richardson, finest, second_scheme, median
  double reference = 0;
  Convergence convergence;       // of the scene's own ladder
  bool cloud = false;            // minute changes are amplified so far that only percentiles mean anything
  std::vector<Besides> besides;  // largest first
  bool schemes_agree = true;
  std::string second_scheme;       // that was asked, empty: there is none that takes another way
  double beside_the_step() const;  // sum of `besides`
};

/// An input's range, and what it does.
struct InputRange {
  std::string key, low, high;                // "vehicle.car.speed", "39 km/h", "41 km/h"
  std::map<std::string, double> half_width;  // per quantity: half of what both ends and the scene's own value span
  std::set<std::string> turns;               // quantities whose own answer lies outside of those of the ends: not monotonic
};

struct Study {
  std::vector<SeriesResult> series;   // the scene's own ladder first
  std::vector<Judgement> judgements;  // per quantity, measures first
  std::vector<InputRange> inputs;
  Notices notices;              // of all runs
  bool rigid_contacts = false;  // the contact solver decides what contacts do
  double interval = 0;          // [s] between recorded instants in all runs but those that vary it
  const Judgement* find(const std::string& quantity) const;
  const SettingResult* own() const;
  /// Half width of what all inputs together do, as independent errors add.
  double input_uncertainty(const std::string& quantity) const;
};

/// Puts the outcomes of one setting (plain run first, then members) together.
SettingResult summarise(const Setting&, const std::vector<Outcome>&);

/// Judges every quantity of the finest or any own-ladder run, and fills errors and uncertainties of all settings.
void judge(Study&, const std::map<std::string, double>& closed_form);

/// The quantity a page is about: one with a closed form, else throw, head impact, delta-v, travel, whichever comes first.
std::string main_quantity(const Study&);
/// The same of bare names; empty if there are none.
std::string main_of(const std::vector<std::string>& quantities);

}  // namespace cli::study
