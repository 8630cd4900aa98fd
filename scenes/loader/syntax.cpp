#include "scenes/loader/syntax.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>
#include <vector>

namespace scenes {
namespace {

constexpr std::string_view kBlank = " \t\r";

std::string_view trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(kBlank);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(kBlank) - first + 1);
}

std::vector<std::string_view> lines_of(std::string_view text) {
  std::vector<std::string_view> out;
  for (std::size_t at = 0; at <= text.size();) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    out.push_back(text.substr(at, end - at));
    at = end + 1;
  }
  return out;
}

/// Where the quoted text that begins at `from` ends: behind its closing quote, npos without one.
std::size_t end_of_text(std::string_view line, std::size_t from) {
  for (std::size_t i = from + 1; i < line.size(); ++i) {
    if (line[from] == '"' && line[i] == '\\')
      ++i;
    else if (line[i] == line[from])
      return i + 1;
  }
  return std::string_view::npos;
}

/// The line without its remark; quotes are respected as far as they are closed.
std::string_view without_remark(std::string_view line) {
  for (std::size_t i = 0; i < line.size(); ++i) {
    if (line[i] == '#') return line.substr(0, i);
    if (line[i] != '"' && line[i] != '\'') continue;
    const std::size_t end = end_of_text(line, i);
    if (end == std::string_view::npos) return line;
    i = end - 1;
  }
  return line;
}

/// A line "key = value".
struct Assignment {
  std::string_view key, value;
};
std::optional<Assignment> assignment_of(std::string_view line) {
  const std::size_t equals = line.find('=');
  if (equals == std::string_view::npos) return std::nullopt;
  return Assignment{trimmed(line.substr(0, equals)), trimmed(without_remark(line.substr(equals + 1)))};
}

bool is_decimal_digit(char c) {
  return c >= '0' && c <= '9';
}
bool starts_a_word(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_' || static_cast<unsigned char>(c) >= 0x80;
}

constexpr std::array<std::string_view, 8> kTypographic{"\u201c", "\u201d", "\u201e", "\u2018",
                                                       "\u2019", "\u201a", "\u00ab", "\u00bb"};

std::optional<std::string> typographic_quotes(std::string_view line) {
  std::string straight(without_remark(line));
  bool any = false;
  for (const std::string_view quote : kTypographic)
    for (std::size_t at = straight.find(quote); at != std::string::npos; at = straight.find(quote)) {
      straight.replace(at, quote.size(), "\"");
      any = true;
    }
  if (!any) return std::nullopt;
  return fmt::format("typographic quotes; write straight ones: {}", trimmed(straight));
}

/// "0,5" -> "0.5" where a digit stands on both sides of every comma.
std::optional<std::string> with_points(std::string_view value) {
  std::string out(value);
  bool any = false;
  for (std::size_t i = 1; i + 1 < out.size(); ++i) {
    if (out[i] != ',') continue;
    if (!is_decimal_digit(out[i - 1]) || !is_decimal_digit(out[i + 1]) || any) return std::nullopt;
    out[i] = '.';
    any = true;
  }
  return any ? std::optional(out) : std::nullopt;
}

std::optional<std::string> forgotten_quotes(const Assignment& line) {
  const std::string_view value = line.value;
  const bool number = !value.empty() && (is_decimal_digit(value[0]) ||
                                         (value.size() > 1 && std::string_view("+-.").find(value[0]) != std::string_view::npos &&
                                          (is_decimal_digit(value[1]) || value[1] == '.')));
  const bool word = !value.empty() && starts_a_word(value[0]);
  if (!number && !word) return std::nullopt;
  if (number) {
    const std::optional<std::string> points = with_points(value);
    const bool unit = std::any_of(value.begin(), value.end(), [](char c) { return starts_a_word(c) || c == '%'; });
    if (points && unit) return fmt::format("{} has a decimal comma and no quotes; write {} = \"{}\"", value, line.key, *points);
    if (points) return fmt::format("{} has a decimal comma; write {} = {}", value, line.key, *points);
    if (!unit && value.find(' ') == std::string_view::npos) return std::nullopt;
  }
  if (value.find('"') != std::string_view::npos) {
    if (std::count(value.begin(), value.end(), '"') != 1 || value.back() != '"') return std::nullopt;
    return fmt::format("the text has no opening quote; write {} = \"{}", line.key, value);
  }
  return fmt::format("{} needs quotes; write {} = \"{}\"", value, line.key, value);
}

std::optional<std::string> open_text(const Assignment& line) {
  const std::string_view value = line.value;
  if (value.empty() || (value[0] != '"' && value[0] != '\'') || end_of_text(value, 0) != std::string_view::npos)
    return std::nullopt;
  return fmt::format("the text has no closing quote; write {} = {}{}", line.key, value, value[0]);
}

std::optional<std::string> open_header(std::string_view line) {
  const std::string_view header = trimmed(without_remark(line));
  if (header.empty() || header[0] != '[') return std::nullopt;
  const bool list = header.starts_with("[[");
  const std::size_t from = list ? 2 : 1;
  const std::string_view name = trimmed(header.substr(from, header.find(']', from) - from));
  const std::string whole = list ? fmt::format("[[{}]]", name) : fmt::format("[{}]", name);
  if (name.empty() || header == whole) return std::nullopt;
  return fmt::format("the section's bracket is not closed; write {}", whole);
}

std::optional<std::string> no_equals(std::string_view line) {
  const std::string_view plain = trimmed(without_remark(line));
  if (plain.empty() || !starts_a_word(plain[0]) || plain.find('=') != std::string_view::npos) return std::nullopt;
  const std::size_t end = plain.find_first_of(" \t:");
  if (end == std::string_view::npos) return fmt::format("{0} has no value; write {0} = ...", plain);
  const std::size_t value = plain.find_first_not_of(" \t:", end);
  if (value == std::string_view::npos) return fmt::format("{0} has no value; write {0} = ...", plain.substr(0, end));
  return fmt::format("there is no = between key and value; write {} = {}", plain.substr(0, end), plain.substr(value));
}

/// The line above `line` where the same key of the same section, or the same section, was given first. 0: none was found.
int first_of_two(const std::vector<std::string_view>& lines, int line) {
  const auto key_at = [&](int n) -> std::string_view {
    const std::string_view plain = trimmed(without_remark(lines[static_cast<std::size_t>(n - 1)]));
    if (plain.starts_with("[")) return plain;
    const auto assignment = assignment_of(plain);
    return assignment ? assignment->key : std::string_view();
  };
  const std::string_view wanted = key_at(line);
  for (int n = line - 1; n > 0; --n) {
    if (!wanted.empty() && key_at(n) == wanted) return n;
    if (key_at(n).starts_with("[") && !wanted.starts_with("[")) return 0;
  }
  return 0;
}

std::optional<std::string> given_twice(const std::vector<std::string_view>& lines, int line, const std::string& description) {
  if (description.find("redefin") == std::string::npos) return std::nullopt;
  const std::string_view plain = trimmed(without_remark(lines[static_cast<std::size_t>(line - 1)]));
  const auto assignment = assignment_of(plain);
  const std::string what(plain.starts_with("[") || !assignment ? plain : assignment->key);
  const int first = first_of_two(lines, line);
  const std::string remedy =
      plain.starts_with("[") && !plain.starts_with("[[") ? "put the keys of both under one of them" : "keep one of them";
  return fmt::format("{} is given twice{}; {}", what, first ? fmt::format(", first in line {}", first) : "", remedy);
}

std::string what_is_wrong(const std::vector<std::string_view>& lines, int line, const std::string& description) {
  const std::string_view text = lines[static_cast<std::size_t>(line - 1)];
  if (const auto twice = given_twice(lines, line, description)) return *twice;
  if (const auto quotes = typographic_quotes(text)) return *quotes;
  if (const auto header = open_header(text)) return *header;
  if (const auto assignment = assignment_of(text)) {
    if (assignment->key.empty()) return "there is no key before the =";
    if (assignment->value.empty()) return fmt::format("{} has no value", assignment->key);
    if (const auto open = open_text(*assignment)) return *open;
    if (const auto quotes = forgotten_quotes(*assignment)) return *quotes;
  } else if (const auto missing = no_equals(text)) {
    return *missing;
  }
  return "not TOML: " + description;
}

struct Signature {
  std::string_view bytes;
  const char* kind;
};
constexpr Signature kOthers[] = {{"\x89PNG", "a PNG picture"},    {"\xff\xd8\xff", "a JPEG picture"}, {"%PDF", "a PDF"},
                                 {"PK\x03\x04", "a ZIP archive"}, {"\x1f\x8b", "a gzip archive"},     {"glTF", "a mesh"}};

/// The first byte that is not UTF-8; npos when all is. Overlong forms pass, the parser refuses them.
std::size_t not_utf8(std::string_view text) {
  for (std::size_t i = 0; i < text.size();) {
    const auto c = static_cast<unsigned char>(text[i]);
    const std::size_t length = c < 0x80 ? 1 : c >= 0xc2 && c < 0xe0 ? 2 : c >= 0xe0 && c < 0xf0 ? 3 : c >= 0xf0 && c < 0xf5 ? 4 : 0;
    if (length == 0 || i + length > text.size()) return i;
    for (std::size_t k = 1; k < length; ++k)
      if ((static_cast<unsigned char>(text[i + k]) & 0xc0) != 0x80) return i;
    i += length;
  }
  return std::string_view::npos;
}

}  // namespace

void refuse_other_files(std::string_view text, const std::string& name) {
  const auto refuse = [&name](const std::string& why, int line) {
    throw SceneErrors({Finding{name, line, 0, line > 0 ? "syntax" : "file", why}});
  };
  for (const Signature& other : kOthers)
    if (text.starts_with(other.bytes)) refuse(fmt::format("is {}, no scene file", other.kind), 0);
  if (text.starts_with("\xff\xfe") || text.starts_with("\xfe\xff")) refuse("is written in UTF-16; save it as UTF-8", 0);
  if (text.find('\0') != std::string_view::npos) refuse("is a binary file, no scene file", 0);
  const std::size_t bad = not_utf8(text);
  if (bad == std::string_view::npos) return;
  const auto line = static_cast<int>(std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(bad), '\n')) + 1;
  refuse("holds a letter that is not UTF-8, as files in Latin-1 or Windows-1252 do; save the file as UTF-8", line);
}

Finding syntax_error(std::string_view text, const Place& place, const std::string& description) {
  const std::vector<std::string_view> lines = lines_of(text);
  int line = place.line;
  // a text that is not closed is noticed at the end of its line, which may count as the next one
  if (line > 1 && place.column <= 1 && description.find("string") != std::string::npos) --line;
  if (line < 1 || line > static_cast<int>(lines.size()))
    return {place.file, place.line, place.column, "syntax", "not TOML: " + description};
  const std::string what = what_is_wrong(lines, line, description);
  return {place.file, line, line == place.line ? place.column : 0, "syntax", what};
}

}  // namespace scenes
