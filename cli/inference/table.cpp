#include "cli/inference/table.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "cli/inference/observe.h"

namespace cli::inference {
namespace {

std::string number(double x) {
  return std::isfinite(x) ? fmt::format("{}", x) : "";
}

}  // namespace

std::string quoted(const std::string& text) {
  if (text.find_first_of(",\"\n") == std::string::npos) return text;
  std::string out = "\"";
  for (const char c : text) out += c == '"' ? "\"\"" : std::string(1, c);
  return out + "\"";
}

void judge(const std::vector<scenes::Evidence>& evidence, Table& table) {
  for (Row& row : table.rows) {
    row.misfits.clear();
    if (!row.answer.ok()) continue;
    for (std::size_t e = 0; e < evidence.size(); ++e) row.misfits.push_back(misfit(evidence[e], row.answer.predicted[e]));
  }
}

std::vector<std::string> outputs_of(const Table& table) {
  std::set<std::string> names;
  for (const Row& row : table.rows)
    for (const auto& [name, value] : row.answer.outputs) names.insert(name);
  return {names.begin(), names.end()};
}

std::vector<double> column(const Table& table, const std::string& output) {
  std::vector<double> out;
  for (const Row& row : table.rows) {
    const auto found = row.answer.outputs.find(output);
    out.push_back(found == row.answer.outputs.end() ? std::numeric_limits<double>::quiet_NaN() : found->second);
  }
  return out;
}

std::string runs_csv(const Prior& prior, const std::vector<scenes::Evidence>& evidence, const Table& table) {
  const std::vector<std::string> outputs = outputs_of(table);
  std::string out = "run,status";
  for (const std::string& key : table.grid_keys) out += "," + quoted("in." + key);
  for (const auto& input : prior.inputs()) out += "," + quoted("in." + input.key);
  for (const std::string& name : outputs) out += "," + quoted("out." + name);
  for (const auto& e : evidence) out += "," + quoted("misfit." + e.name);
  out += ",notes\n";
  for (std::size_t i = 0; i < table.rows.size(); ++i) {
    const Row& row = table.rows[i];
    out += fmt::format("{},{}", i + 1, quoted(row.answer.status));
    for (const std::string& value : row.grid) out += "," + quoted(value);
    for (std::size_t k = 0; k < row.values.size(); ++k) {
      const auto& input = prior.inputs()[k];
      const bool choice = input.spread == scenes::Spread::choice;
      out += "," + (choice ? quoted(input.choices[static_cast<std::size_t>(row.values[k])]) : number(row.values[k]));
    }
    for (const std::string& name : outputs) {
      const auto found = row.answer.outputs.find(name);
      out += "," + (found == row.answer.outputs.end() ? "" : number(found->second));
    }
    for (std::size_t e = 0; e < evidence.size(); ++e) out += "," + (e < row.misfits.size() ? number(row.misfits[e]) : "");
    out += "," + quoted(as_field(row.answer.notes)) + "\n";
  }
  return out;
}

Notices notices_of(const Table& table) {
  Notices out;
  for (const Row& row : table.rows) out.add(row.answer.notes);
  return out;
}

std::string told(double si, const scenes::WrittenUnit& unit, double resolution) {
  const double value = si / unit.factor, fine = std::max(std::abs(resolution / unit.factor), 1e-12);
  const int decimals = std::clamp(static_cast<int>(std::ceil(-std::log10(fine))), 0, 6);
  return fmt::format("{:.{}f}{}{}", value, decimals, unit.name.empty() ? "" : " ", unit.name);
}

}  // namespace cli::inference
