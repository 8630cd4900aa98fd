// Where values stand on a chart, and its ticks. Whatever the numbers are: what is drawn has finite coordinates and few ticks.
#pragma once

#include <limits>
#include <string>
#include <vector>

namespace render::charts {

/// The span of one axis, and where on the paper it lies.
struct Axis {
  double low = std::numeric_limits<double>::infinity();
  double high = -std::numeric_limits<double>::infinity();
  bool log = false;
  double from = 0, to = 0;  // [pt] on the paper, of `low` and `high`

  /// Has the axis reach to the value, if it can be shown.
  void take(double value);
  /// No value was taken.
  bool empty() const { return !(high >= low); }
  /// Some room at both ends; to be called once all values are taken.
  void widen();
  /// A finite number whose differences from others and ratios to them are numbers too. What it is not has no place.
  static bool shows(double value);
  /// [pt] Of a value that is shown. Far off the paper is as good as farther; on a logarithmic axis zero and below lie there.
  double at(double value) const;
};

/// Round values from `low` to `high`, about `count` of them; powers of ten (with 2 and 5 if there are few) when `logarithmic`. Only
/// `low` where no two can be told apart, none between what is not finite.
std::vector<double> ticks(double low, double high, int count, bool logarithmic);
/// A tick as it is written: "0.5", "20", "10⁻⁵"; with the digits that tell it from one `spacing` away.
std::string tick_text(double value, double spacing = 0);

}  // namespace render::charts
