// Where ticks stand and how they read.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "render/charts/page.h"

namespace render::charts {
namespace {

std::vector<double> even_ticks(double low, double high, int count) {
  const double rough = (high - low) / std::max(1, count);
  const double power = std::pow(10, std::floor(std::log10(rough)));
  double step = 10 * power;
  for (const double round : {1.0, 2.0, 5.0})
    if (round * power >= rough) {
      step = round * power;
      break;
    }
  std::vector<double> out;
  for (double k = std::ceil(low / step - 1e-9); k * step <= high + 1e-9 * step; ++k) out.push_back(k * step);
  return out;
}

std::vector<double> log_ticks(double low, double high, int count) {
  const double decades = std::log10(high / low);
  const int stride = std::max(1, static_cast<int>(std::ceil(decades / count)));
  std::vector<double> out;
  for (int k = static_cast<int>(std::floor(std::log10(low))); k <= static_cast<int>(std::ceil(std::log10(high))); ++k) {
    if (k % stride != 0) continue;
    for (const double round : {1.0, 2.0, 5.0}) {
      if (round > 1 && decades > 2.2) break;
      const double value = round * std::pow(10, k);
      if (value >= low * (1 - 1e-9) && value <= high * (1 + 1e-9)) out.push_back(value);
    }
  }
  return out;
}

/// "10\u207b\u2076", "2\u00b710\u207b\u2076".
std::string scientific(double value) {
  constexpr const char* kRaised[] = {"\u2070", "\u00b9", "\u00b2", "\u00b3", "\u2074",
                                     "\u2075", "\u2076", "\u2077", "\u2078", "\u2079"};
  const int power = static_cast<int>(std::floor(std::log10(std::abs(value)) + 1e-9));
  const std::string mantissa = fmt::format("{:.3g}", value / std::pow(10, power));
  std::string out = mantissa == "1" ? "10" : mantissa == "-1" ? "-10" : mantissa + "\u00b710";
  if (power < 0) out += "\u207b";
  for (const char digit : fmt::format("{}", std::abs(power))) out += kRaised[digit - '0'];
  return out;
}

}  // namespace

std::vector<double> ticks(double low, double high, int count, bool logarithmic) {
  if (!(high > low)) return {low};
  if (!logarithmic) return even_ticks(low, high, count);
  const std::vector<double> powers = log_ticks(low, high, count);
  return powers.size() < 2 ? even_ticks(low, high, count) : powers;  // less than a factor of two
}

std::string tick_text(double value, double spacing) {
  const double size = std::abs(value);
  if (size != 0 && (size < 1e-3 || size >= 1e5)) return scientific(value);
  if (spacing > 0 && size < 1e-9 * spacing) return "0";
  const int digits = spacing > 0 && size > 0 ? static_cast<int>(std::ceil(std::log10(size / spacing))) + 2 : 6;
  return fmt::format("{:.{}g}", value, std::clamp(digits, 1, 15));
}

}  // namespace render::charts
