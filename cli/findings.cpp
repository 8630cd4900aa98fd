#include "cli/findings.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <optional>

namespace cli {
namespace {

constexpr std::size_t kLongestLine = 160;  // [byte] longer ones are no help on a terminal

std::optional<std::string> line_of(const std::string& file, int number) {
  std::error_code problem;
  if (!std::filesystem::is_regular_file(file, problem)) return std::nullopt;  // a pipe is read once
  std::ifstream in(file, std::ios::binary);
  std::string line;
  for (int n = 0; n < number; ++n)
    if (!std::getline(in, line)) return std::nullopt;
  if (!line.empty() && line.back() == '\r') line.pop_back();
  // what could steer a terminal is not shown
  const bool plain = std::none_of(line.begin(), line.end(), [](unsigned char c) { return (c < 0x20 && c != '\t') || c == 0x7f; });
  if (line.size() > kLongestLine || !plain) return std::nullopt;
  return line;
}

/// Blanks as wide as the first `column - 1` characters of the line.
std::string blanks(const std::string& line, int column) {
  std::string out;
  int character = 0;
  for (const char c : line) {
    if ((static_cast<unsigned char>(c) & 0xc0) == 0x80) continue;  // the rest of a character of several bytes
    if (++character >= column) break;
    out += c == '\t' ? '\t' : ' ';
  }
  return out;
}

std::optional<int> number_in(std::string_view text) {
  int value = 0;
  const auto [end, problem] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (problem != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

}  // namespace

std::string finding_text(const scenes::Finding& finding) {
  std::string out = (finding.file.starts_with("--") ? "crashreel: " : "") + finding.text() + "\n";
  if (finding.line == 0) return out;
  const std::optional<std::string> line = line_of(finding.file, finding.line);
  if (!line) return out;
  out += fmt::format("{:5} | {}\n", finding.line, *line);
  if (finding.column > 0) out += fmt::format("      | {}^\n", blanks(*line, finding.column));
  return out;
}

nlohmann::ordered_json finding_json(const scenes::Finding& finding) {
  nlohmann::ordered_json out = {{"file", finding.file}, {"line", nullptr}, {"column", nullptr}};
  if (finding.line > 0) out["line"] = finding.line;
  if (finding.column > 0) out["column"] = finding.column;
  out["code"] = finding.code;
  out["message"] = finding.what;
  return out;
}

scenes::Finding finding_of(const std::string& line, const std::string& code) {
  const std::size_t end = line.find(": ");
  if (end == std::string::npos) return {"", 0, 0, code, line};
  scenes::Finding out{line.substr(0, end), 0, 0, code, line.substr(end + 2)};
  const std::size_t second = out.file.rfind(':');
  const std::size_t first = second == std::string::npos ? second : out.file.rfind(':', second - 1);
  if (first == std::string::npos) return out;
  const auto row = number_in(std::string_view(out.file).substr(first + 1, second - first - 1));
  const auto column = number_in(std::string_view(out.file).substr(second + 1));
  if (!row || !column) return out;
  out.line = *row;
  out.column = *column;
  out.file.resize(first);
  return out;
}

}  // namespace cli
