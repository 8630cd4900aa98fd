#include "render/charts/axes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace render::charts {
namespace {

constexpr double kLargest = 1e100;  // of a value: ratios of two of them and what widens an axis are far from the largest double
constexpr double kOffPaper = 1e5;   // [pt] cairo's fixed-point numbers hold 80 times that

std::vector<double> even_ticks(double low, double high, int count) {
  const double rough = high / count - low / count;
  // multiples of the step are counted by a double, and so are the digits that tell them apart
  const double finest = 1e-15 * std::max(std::abs(low), std::abs(high));
  if (!std::isfinite(rough) || rough < std::max(finest, 1e-300)) return {low};
  const double power = std::pow(10, std::floor(std::log10(rough)));
  double step = 10 * power;
  for (const double round : {1.0, 2.0, 5.0})
    if (round * power >= rough) {
      step = round * power;
      break;
    }
  std::vector<double> out;
  for (double k = std::ceil(low / step - 1e-9); k * step <= high + 1e-9 * step && std::isfinite(k * step); ++k)
    out.push_back(k * step);
  return out;
}

std::vector<double> log_ticks(double low, double high, int count) {
  const double decades = std::log10(high) - std::log10(low);
  const int stride = std::max(1, static_cast<int>(std::ceil(decades / count)));
  std::vector<double> out;
  for (int k = static_cast<int>(std::floor(std::log10(low))); k <= static_cast<int>(std::ceil(std::log10(high))); ++k) {
    if (k % stride != 0) continue;
    for (const double round : {1.0, 2.0, 5.0}) {
      if (round > 1 && decades > 2.2) break;
      const double value = round * std::pow(10, k);
      if (std::isfinite(value) && value >= low * (1 - 1e-9) && value <= high * (1 + 1e-9)) out.push_back(value);
    }
  }
  return out;
}

/// "10\u207b\u2076", "2\u00b710\u207b\u2076".
std::string scientific(double value) {
  constexpr const char* kRaised[] = {"\u2070", "\u00b9", "\u00b2", "\u00b3", "\u2074",
                                     "\u2075", "\u2076", "\u2077", "\u2078", "\u2079"};
  const std::string digits = fmt::format("{:.2e}", value);  // "-2.50e-06"
  const std::size_t e = digits.find('e');
  std::string mantissa = digits.substr(0, e), power = digits.substr(e + 2);
  mantissa.erase(mantissa.find_last_not_of('0') + 1);
  if (mantissa.back() == '.') mantissa.pop_back();
  power.erase(0, std::min(power.find_first_not_of('0'), power.size() - 1));
  std::string out = mantissa == "1" ? "10" : mantissa == "-1" ? "-10" : mantissa + "\u00b710";
  if (digits[e + 1] == '-') out += "\u207b";
  for (const char digit : power) out += kRaised[digit - '0'];
  return out;
}

}  // namespace

bool Axis::shows(double value) {
  return std::abs(value) <= kLargest;
}

void Axis::take(double value) {
  if (!shows(value) || (log && value < 1 / kLargest)) return;
  low = std::min(low, value);
  high = std::max(high, value);
}

void Axis::widen() {
  if (log) {
    const double room = std::max(1.12, std::pow(high / low, 0.06));
    low /= room;
    high *= room;
  } else {
    const double room = high > low ? 0.08 * (high - low) : std::max(1e-9, 0.01 * std::abs(high));
    // what rounding alone tells apart is not drawn as if it were a difference
    const double least = std::max(1e-100, 1e-13 * std::max(std::abs(low), std::abs(high)));
    low -= std::max(room, least);
    high += std::max(room, least);
  }
}

double Axis::at(double value) const {
  const double share = log ? std::log(std::max(value, low * 1e-9) / low) / std::log(high / low) : (value - low) / (high - low);
  return std::clamp(from + share * (to - from), -kOffPaper, kOffPaper);
}

std::vector<double> ticks(double low, double high, int count, bool logarithmic) {
  if (!std::isfinite(low) || !std::isfinite(high)) return {};
  if (!(high > low)) return {low};
  count = std::max(1, count);
  if (!logarithmic || low <= 0) return even_ticks(low, high, count);
  const std::vector<double> powers = log_ticks(low, high, count);
  return powers.size() < 2 ? even_ticks(low, high, count) : powers;  // less than a factor of two
}

std::string tick_text(double value, double spacing) {
  if (!std::isfinite(value)) return fmt::format("{}", value);
  const double size = std::abs(value);
  if (size != 0 && (size < 1e-3 || size >= 1e5)) return scientific(value);
  if (spacing > 0 && size < 1e-9 * spacing) return "0";
  const double digits = spacing > 0 && size > 0 ? std::ceil(std::log10(size / spacing)) + 2 : 6;
  return fmt::format("{:.{}g}", value, static_cast<int>(std::clamp(digits, 1.0, 15.0)));
}

}  // namespace render::charts
