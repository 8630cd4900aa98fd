#include "cli/inference/driver.h"

#include <fmt/format.h>

#include <cmath>
#include <set>
#include <sstream>

#include "cli/exit.h"
#include "cli/inference/table.h"
#include "scenes/loader/uncertain.h"

namespace cli::inference {
namespace {

bool is_bare(const std::string& text) {
  return !text.empty() && text.find_first_not_of("0123456789.eE+-") == std::string::npos;
}

std::string trimmed(std::string text) {
  while (!text.empty() && (text.back() == ' ' || text.back() == '\r' || text.back() == '\t')) text.pop_back();
  const std::size_t begin = text.find_first_not_of(" \t");
  return begin == std::string::npos ? "" : text.substr(begin);
}

std::vector<std::string> fields_of(const std::string& line) {
  std::vector<std::string> out(1);
  bool quotes = false;
  for (const char c : line) {
    if (c == '"')
      quotes = !quotes;
    else if (c == ',' && !quotes)
      out.emplace_back();
    else
      out.back() += c;
  }
  for (std::string& field : out) field = trimmed(field);
  return out;
}

/// "2 variables": the count and the word of a section of Dakota's file.
bool is_count(const std::string& line, const std::string& word, int& count) {
  std::istringstream in(line);
  std::string name;
  return (in >> count) && (in >> name) && name == word && count >= 0;
}

Request read_dakota(const std::vector<std::string>& lines) {
  Request out;
  out.dakota = true;
  out.values.emplace_back();
  int count = 0;
  is_count(lines.front(), "variables", count);
  std::size_t at = 1;
  for (int i = 0; i < count; ++i, ++at) {
    std::istringstream in(at < lines.size() ? lines[at] : "");
    std::string value, name;
    if (!(in >> value >> name)) throw UsageError(fmt::format("the parameters file says {} variables and has {}", count, i));
    out.keys.push_back(name);
    out.values[0].push_back(value);
  }
  if (at >= lines.size() || !is_count(lines[at], "functions", count)) return out;
  for (int i = 0; i < count; ++i) {
    std::istringstream in(++at < lines.size() ? lines[at] : "");
    int wanted = 0;
    std::string name;
    if (!(in >> wanted >> name)) throw UsageError(fmt::format("the parameters file says {} functions and has {}", count, i));
    if (wanted != 1) throw UsageError(fmt::format("{}: only values can be had (1), no derivatives", name));
    out.measures.push_back(name.substr(name.find(':') + 1));
  }
  return out;
}

Request read_table(const std::vector<std::string>& lines) {
  Request out;
  out.keys = fields_of(lines.front());
  for (std::size_t i = 1; i < lines.size(); ++i) {
    out.values.push_back(fields_of(lines[i]));
    if (out.values.back().size() != out.keys.size())
      throw UsageError(fmt::format("row {} of the parameters has {} values, the first line has {} keys", i,
                                   out.values.back().size(), out.keys.size()));
  }
  if (out.values.empty()) throw UsageError("the parameters file has no row of values below its keys");
  return out;
}

bool has_all(const Request& request, const Answer& a) {
  if (!a.ok()) return false;
  for (const std::string& name : request.measures)
    if (!a.outputs.contains(name)) return false;
  return true;
}

std::string reason_of(const Request& request, const Answer& a) {
  if (!a.ok()) return a.status;
  for (const std::string& name : request.measures)
    if (!a.outputs.contains(name)) return fmt::format("the run has no measure {}", name);
  return "ok";
}

}  // namespace

Request read_request(const scenes::Scene& scene, const std::string& text) {
  // a message that names something of the file would end there
  if (text.find('\0') != std::string::npos)
    throw UsageError("the parameters file holds bytes of zero; write it as plain text, in UTF-8");
  std::vector<std::string> lines;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);)
    if (line = trimmed(line); !line.empty()) lines.push_back(line);
  if (lines.empty()) throw UsageError("the parameters file is empty");
  if (lines.front().front() == '{')
    throw UsageError(
        "the parameters file is in Dakota's aprepro format; take its standard format (leave aprepro out of the interface)");
  int count = 0;
  Request out = is_count(lines.front(), "variables", count) ? read_dakota(lines) : read_table(lines);
  const scenes::Value root = scenes::parse_text(scene.file.text, scene.path.string());
  for (std::size_t k = 0; k < out.keys.size(); ++k) {
    const scenes::KeyUnit unit = scenes::unit_of_key(root, out.keys[k]);
    if (!unit.problem.empty()) throw UsageError(fmt::format("parameter {} {}", out.keys[k], unit.problem));
    for (auto& values : out.values)
      if (is_bare(values[k]) && !unit.si_unit.empty()) values[k] += " " + unit.si_unit;
  }
  return out;
}

std::vector<std::string> overrides_of(const Request& request, std::size_t run) {
  std::vector<std::string> out;
  for (std::size_t k = 0; k < request.keys.size(); ++k) out.push_back(request.keys[k] + "=" + request.values[run][k]);
  return out;
}

int failed(const Request& request, const std::vector<Answer>& answers) {
  int out = 0;
  for (const Answer& a : answers) out += !has_all(request, a);
  return out;
}

std::string results(const Request& request, const std::vector<Answer>& answers) {
  if (request.dakota) {
    const Answer& a = answers.front();
    if (!has_all(request, a)) return "fail\n" + reason_of(request, a) + "\n";
    std::string out;
    if (request.measures.empty())
      for (const auto& [name, value] : a.outputs) out += fmt::format("{} {}\n", value, name);
    for (const std::string& name : request.measures) out += fmt::format("{} {}\n", a.outputs.at(name), name);
    return out;
  }
  std::set<std::string> all;
  for (const Answer& a : answers)
    for (const auto& [name, value] : a.outputs) all.insert(name);
  const std::vector<std::string> columns =
      request.measures.empty() ? std::vector<std::string>(all.begin(), all.end()) : request.measures;
  std::string out = "row,status";
  for (const std::string& name : columns) out += "," + quoted(name);
  out += ",notes\n";
  for (std::size_t i = 0; i < answers.size(); ++i) {
    const std::string reason = reason_of(request, answers[i]);
    out += fmt::format("{},{}", i + 1, quoted(reason == "ok" ? reason : "fail: " + reason));
    for (const std::string& name : columns) {
      const auto found = answers[i].outputs.find(name);
      const bool there = found != answers[i].outputs.end() && std::isfinite(found->second);
      out += "," + (there ? fmt::format("{}", found->second) : std::string());
    }
    out += "," + quoted(as_field(answers[i].notes)) + "\n";
  }
  // the first word says that not all is well
  return failed(request, answers) == static_cast<int>(answers.size()) ? "fail\n" + out : out;
}

}  // namespace cli::inference
