#include "cli/inference/sample.h"

#include <fmt/format.h>

#include <algorithm>
#include <boost/math/distributions/binomial.hpp>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>

#include "cli/exit.h"
#include "cli/inference/sequence.h"
#include "cli/study/statistics.h"
#include "engine/measure/definitions.h"

namespace cli::inference {
namespace {

constexpr double kShares[] = {0.025, 0.05, 0.25, 0.5, 0.75, 0.95, 0.975};
constexpr double kTold = 1e-5;  // of a measure and in its unit: what varies less is the arithmetic's, and no axis can show it
constexpr std::size_t kMostRows = 10'000'000;  // a table of a gigabyte

bool is_bare(const std::string& text) {
  return !text.empty() && text.find_first_not_of("0123456789.eE+- ") == std::string::npos;
}

/// The measure people ask for first, of those that vary.
std::string main_output(const std::vector<Output>& outputs) {
  for (const char* wanted : {"throw_distance_m", "delta_v_mps", "travel_m", "rest_s"})
    for (const Output& o : outputs)
      if (o.name.starts_with(wanted)) return o.name;
  return outputs.empty() ? "" : outputs.front().name;
}

}  // namespace

GridAxis parse_grid(const std::string& text) {
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos || equals == 0 || equals + 1 == text.size())
    throw UsageError(fmt::format("--grid is \"{}\": must be KEY=VALUES, like vehicle.sedan.speed=\"30,40,50 km/h\"", text));
  GridAxis out{text.substr(0, equals), {}};
  std::string rest = text.substr(equals + 1);
  for (std::size_t comma; (comma = rest.find(',')) != std::string::npos; rest.erase(0, comma + 1))
    out.values.push_back(rest.substr(0, comma));
  out.values.push_back(rest);
  const std::size_t unit = rest.find_first_not_of("0123456789.eE+- ");
  if (unit != std::string::npos && unit > 0)
    for (std::string& value : out.values)
      if (is_bare(value)) value += " " + rest.substr(unit);
  return out;
}

Table plan_rows(const Prior& prior, const std::vector<GridAxis>& grid, std::uint64_t count, std::uint64_t seed) {
  Table out;
  std::vector<std::vector<std::string>> corners{{}};
  for (const GridAxis& axis : grid) {
    for (const auto& input : prior.inputs())
      if (input.key == axis.key)
        throw UsageError(fmt::format("--grid {} is uncertain in the scene; a key can be one of both", axis.key));
    out.grid_keys.push_back(axis.key);
    std::vector<std::vector<std::string>> more;
    for (const auto& corner : corners)
      for (const std::string& value : axis.values) {
        more.push_back(corner);
        more.back().push_back(value);
      }
    corners = std::move(more);
  }
  const bool drawn = prior.size() > 0 && count > 0;
  if (corners.size() * (drawn ? count : 1) > kMostRows)
    throw UsageError(fmt::format("the plan has more than {} runs; make -n or --grid smaller", kMostRows));
  const auto points = drawn ? scrambled_points(prior.size(), 0, count, seed) : std::vector<std::vector<double>>(1);
  for (const auto& corner : corners)
    for (const std::vector<double>& point : points) {
      Row row;
      for (const double u : point) row.scores.push_back(normal_score(u));
      if (drawn) row.values = prior.values(row.scores);
      row.grid = corner;
      out.rows.push_back(std::move(row));
    }
  return out;
}

std::vector<std::string> overrides_of(const Prior& prior, const Table& table, const Row& row) {
  std::vector<std::string> out;
  for (std::size_t k = 0; k < table.grid_keys.size(); ++k) out.push_back(table.grid_keys[k] + "=" + row.grid[k]);
  if (row.values.empty()) return out;
  for (std::string& text : prior.overrides(row.values)) out.push_back(std::move(text));
  return out;
}

bool is_chosen(const Table& table) {
  return !table.grid_keys.empty() && (table.rows.empty() || table.rows.front().values.empty());
}

Percentile percentile_of(std::vector<double> sample, double share) {
  constexpr double kNot = std::numeric_limits<double>::quiet_NaN();
  Percentile out{share, study::percentile(sample, share), kNot, kNot};
  if (sample.empty()) return out;
  std::sort(sample.begin(), sample.end());
  // how many of n lie below the true percentile is binomial
  const boost::math::binomial below(static_cast<double>(sample.size()), share);
  const double low = boost::math::quantile(below, 0.025), high = boost::math::quantile(below, 0.975) + 1;
  if (low >= 1) out.low = sample[static_cast<std::size_t>(low) - 1];
  if (high <= static_cast<double>(sample.size())) out.high = sample[static_cast<std::size_t>(high) - 1];
  return out;
}

std::vector<std::pair<std::string, int>> failures_of(const Table& table) {
  std::map<std::string, int> counts;
  for (const Row& row : table.rows)
    if (!row.answer.ok()) ++counts[row.answer.status];
  std::vector<std::pair<std::string, int>> out(counts.begin(), counts.end());
  std::stable_sort(out.begin(), out.end(), [](const auto& a, const auto& b) { return a.second > b.second; });
  return out;
}

Sample summarise(const scenes::Scene&, const Prior& prior, Table table, std::uint64_t seed) {
  Sample out;
  out.seed = seed;
  out.failures = failures_of(table);
  std::vector<std::vector<double>> shares;
  for (const Row& row : table.rows) {
    shares.emplace_back();
    for (const double z : row.scores) shares.back().push_back(normal_share(z));
  }
  for (const std::string& name : outputs_of(table)) {
    std::vector<double> all = column(table, name), values;
    for (double& x : all)
      if (std::isfinite(x)) values.push_back(x = engine::turned_to(name, x, values.empty() ? x : values.front()));
    if (values.empty()) continue;
    Output o;
    o.name = name;
    o.runs = values.size();
    const auto n = static_cast<double>(values.size());
    o.mean = std::accumulate(values.begin(), values.end(), 0.0) / n;
    for (const double x : values) o.sd += (x - o.mean) * (x - o.mean);
    o.sd = n > 1 ? std::sqrt(o.sd / (n - 1)) : 0;
    for (const double share : kShares) o.percentiles.push_back(percentile_of(values, share));
    // with a grid the variance is not that of what is unknown
    if (table.grid_keys.empty() && prior.size() > 0) o.sensitivity = sensitivity(prior.inputs(), shares, all, seed);
    out.outputs.push_back(std::move(o));
  }
  std::vector<Output> varying;
  std::copy_if(out.outputs.begin(), out.outputs.end(), std::back_inserter(varying),
               [](const Output& o) { return o.sd > kTold && o.sd > kTold * std::abs(o.mean); });
  out.main = main_output(varying);
  out.table = std::move(table);
  return out;
}

}  // namespace cli::inference
