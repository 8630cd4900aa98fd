// crashreel sample: a plan of runs over what is not known, and what comes of it.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <utility>
#include <vector>

#include "cli/inference/sensitivity.h"
#include "cli/inference/table.h"
#include "render/charts/page.h"
#include "scenes/scene.h"

namespace cli::inference {

/// "KEY=V1,V2,V3" of --grid: the texts of an override each; a unit behind the last holds for bare numbers before it. Throws
/// UsageError.
struct GridAxis {
  std::string key;
  std::vector<std::string> values;
};
GridAxis parse_grid(const std::string& text);

/// Rows without answers: `count` points of the prior at every point of the grid, the same ones at each; with no uncertain inputs or
/// a count of zero one row at every point of the grid, the rest as the scene has it. Throws UsageError.
Table plan_rows(const Prior&, const std::vector<GridAxis>&, std::uint64_t count, std::uint64_t seed);
/// The overrides of a row.
std::vector<std::string> overrides_of(const Prior&, const Table&, const Row&);

/// Chosen values are no sample: nothing is drawn, so no share of the runs is a probability.
bool is_chosen(const Table&);

/// A percentile with the range of order statistics that holds it in 95 of 100 samples, whatever the distribution. A range that
/// would lie outside of the sample is NaN at that end.
struct Percentile {
  double share = 0, value = 0, low = 0, high = 0;
};
Percentile percentile_of(std::vector<double> sample, double share);

/// What the runs say of one measure.
struct Output {
  std::string name;  // "throw_distance_m"
  std::size_t runs = 0;
  double mean = 0, sd = 0;
  std::vector<Percentile> percentiles;  // 5, 25, 50, 75, 95 and the ends of the middle 95 %
  Sensitivity sensitivity;
};

struct Sample {
  Table table;
  std::vector<Output> outputs;                        // those that vary
  std::vector<std::pair<std::string, int>> failures;  // reason and how often
  std::uint64_t seed = 0;
  std::string main;  // the output the page is about
};

Sample summarise(const scenes::Scene&, const Prior&, Table, std::uint64_t seed);

nlohmann::ordered_json sample_json(const scenes::Scene&, const Prior&, const Sample&);
std::string sample_text(const scenes::Scene&, const Prior&, const Sample&);
render::charts::Page sample_page(const scenes::Scene&, const Prior&, const Sample&);

/// The prior in words: "uniform 38 to 52 km/h".
std::string in_words(const scenes::Uncertain&);
/// Reasons for which runs have no answer, with how often.
std::vector<std::pair<std::string, int>> failures_of(const Table&);

}  // namespace cli::inference
