#include "cli/parse.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>

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

constexpr int kLargestSide = 16384;  // [px] what the renderer's targets can hold

}  // namespace

double parse_time(const std::string& option, const std::string& text) {
  double seconds = 0;
  if (!read_whole(text, seconds)) {
    const scenes::Quantity quantity = scenes::parse_quantity(text, scenes::Dimension::time);
    if (!quantity.problem.empty()) throw UsageError(fmt::format("{} is \"{}\", {}", option, text, quantity.problem));
    seconds = quantity.value;
  }
  if (!std::isfinite(seconds) || seconds < 0)
    throw UsageError(fmt::format("{} is \"{}\", must be a time from 0 on, like 0.2s", option, text));
  return seconds;
}

std::pair<int, int> parse_size(const std::string& option, const std::string& text) {
  const std::size_t cross = text.find('x');
  int width = 0;
  int height = 0;
  if (cross == std::string::npos || !read_whole(std::string_view(text).substr(0, cross), width) ||
      !read_whole(std::string_view(text).substr(cross + 1), height)) {
    throw UsageError(fmt::format("{} is \"{}\", must be WIDTHxHEIGHT, like 1280x720", option, text));
  }
  if (width < 16 || height < 16 || width > kLargestSide || height > kLargestSide) {
    throw UsageError(fmt::format("{} is \"{}\", each side must lie in 16..{} pixels", option, text, kLargestSide));
  }
  return {width, height};
}

std::pair<int, int> parse_frames(const std::string& option, const std::string& text) {
  const std::size_t colon = text.find(':');
  int first = -1;
  int last = -1;
  const std::string_view all = text;
  bool good = colon != std::string::npos && text.size() > 1;
  if (good && colon > 0) good = read_whole(all.substr(0, colon), first) && first >= 0;
  if (good && colon + 1 < text.size()) good = read_whole(all.substr(colon + 1), last) && last >= 0;
  if (!good || (first >= 0 && last >= 0 && last < first)) {
    throw UsageError(fmt::format("{} is \"{}\", must be FIRST:LAST, like 10:20, counted from 0, both drawn", option, text));
  }
  return {first, last};
}

int parse_integer(const std::string& option, const std::string& text, int lower, int upper) {
  int value = 0;
  if (!read_whole(text, value) || value < lower || value > upper) {
    throw UsageError(fmt::format("{} is \"{}\", must be a whole number in {}..{}", option, text, lower, upper));
  }
  return value;
}

double parse_number(const std::string& option, const std::string& text, double lower, double upper) {
  double value = 0;
  if (!read_whole(text, value) || !(value >= lower && value <= upper)) {
    throw UsageError(fmt::format("{} is \"{}\", must be a number in {}..{}", option, text, lower, upper));
  }
  return value;
}

}  // namespace cli
