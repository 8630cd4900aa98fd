#include "cli/parse.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>

#include "cli/exit.h"
#include "scenes/loader/quantity.h"

namespace cli {
namespace {

/// The whole text as a number, in the C locale whatever the user's; false when something else stands there.
template <typename Number>
bool read_whole(std::string_view text, Number& out) {
  const auto [end, problem] = std::from_chars(text.data(), text.data() + text.size(), out);
  return problem == std::errc() && end == text.data() + text.size() && !text.empty();
}

/// One entry of a list of frames; nothing when it is none.
std::optional<FrameRange> read_range(std::string_view text) {
  FrameRange range;
  const std::size_t dash = text.find('-');
  std::size_t separator = dash;
  if (dash == std::string_view::npos) separator = text.find(':');  // FIRST:LAST
  if (separator == std::string_view::npos) {
    if (!read_whole(text, range.first) || range.first < 0) return std::nullopt;
    range.last = range.first;
    return range;
  }
  std::string_view first = text.substr(0, separator), last = text.substr(separator + 1);
  const std::size_t step = last.find_first_of("x:");
  if (step != std::string_view::npos) {
    if (!read_whole(last.substr(step + 1), range.step) || range.step < 1) return std::nullopt;
    last = last.substr(0, step);
  }
  if (first.empty() && last.empty()) return std::nullopt;
  if (!first.empty() && (!read_whole(first, range.first) || range.first < 0)) return std::nullopt;
  if (!last.empty() && (!read_whole(last, range.last) || range.last < range.first)) return std::nullopt;
  return range;
}

constexpr int kLargestSide = 16384;  // [px] what the renderer's targets can hold

}  // namespace

double parse_time(const std::string& option, const std::string& text) {
  const scenes::Quantity quantity = scenes::parse_quantity(text, scenes::Dimension::time);
  // seconds may be left out on the command line: there is nothing else they could be
  const bool bare = quantity.bare.has_value();
  if (!quantity.problem.empty() && !bare) {
    // a decimal comma in such a number: the parser of quantities looks for a unit behind it
    std::string point = text;
    std::replace(point.begin(), point.end(), ',', '.');
    const bool comma = point != text && scenes::parse_quantity(point, scenes::Dimension::time).bare.has_value();
    throw UsageError(fmt::format("{} is \"{}\": {}", option, text,
                                 comma ? fmt::format("has a decimal comma; write \"{}\"", point) : quantity.problem));
  }
  const double seconds = bare ? *quantity.bare : quantity.value;
  if (!std::isfinite(seconds) || seconds < 0)
    throw UsageError(fmt::format("{} is \"{}\": must be a time from 0 on, like 0.2s", option, text));
  return seconds;
}

std::pair<int, int> parse_size(const std::string& option, const std::string& text) {
  const std::size_t cross = text.find('x');
  int width = 0;
  int height = 0;
  if (cross == std::string::npos || !read_whole(std::string_view(text).substr(0, cross), width) ||
      !read_whole(std::string_view(text).substr(cross + 1), height)) {
    throw UsageError(fmt::format("{} is \"{}\": must be WIDTHxHEIGHT, like 1280x720", option, text));
  }
  if (width < 16 || height < 16 || width > kLargestSide || height > kLargestSide) {
    throw UsageError(fmt::format("{} is \"{}\": each side must lie in 16..{} pixels", option, text, kLargestSide));
  }
  return {width, height};
}

std::vector<FrameRange> parse_frames(const std::string& option, const std::string& text) {
  std::vector<FrameRange> out;
  for (std::size_t at = 0; at <= text.size();) {
    const std::size_t comma = std::min(text.find(',', at), text.size());
    const std::optional<FrameRange> range = read_range(std::string_view(text).substr(at, comma - at));
    if (!range) {
      throw UsageError(fmt::format(
          "{} is \"{}\": must be frames counted from 0: 7, 10-20, 10-20x5 (every fifth), 10-, -20, or a list of these with commas",
          option, text));
    }
    out.push_back(*range);
    at = comma + 1;
  }
  return out;
}

int parse_integer(const std::string& option, const std::string& text, int lower, int upper) {
  int value = 0;
  if (!read_whole(text, value) || value < lower || value > upper) {
    throw UsageError(fmt::format("{} is \"{}\": must be a whole number in {}..{}", option, text, lower, upper));
  }
  return value;
}

double parse_number(const std::string& option, const std::string& text, double lower, double upper) {
  double value = 0;
  if (!read_whole(text, value) || !(value >= lower && value <= upper)) {
    throw UsageError(fmt::format("{} is \"{}\": must be a number in {}..{}", option, text, lower, upper));
  }
  return value;
}

}  // namespace cli
