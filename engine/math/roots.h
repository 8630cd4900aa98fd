// Roots of functions of one variable inside a bracket: halving, regula falsi, Newton. Sums, products and quotients only, so that
// all processors find the same bits.
#pragma once

#include <cmath>
#include <limits>

namespace engine::math {

/// From `low` to `high` a property ceases to hold, or a function changes its sign.
struct Bracket {
  double low = 0, high = 1;

  double width() const { return high - low; }
  bool contains(double x) const { return x > low && x < high; }
  double middle() const { return 0.5 * (low + high); }
  /// x where it lies inside, else the middle.
  double inside(double x) const { return contains(x) ? x : middle(); }
};

constexpr int kToTheWidth = std::numeric_limits<int>::max();  // as many halvings as the width asks for

/// Halves the bracket at most `halvings` times, while it is wider than `width` and there are numbers inside. `holds(x)` says
/// whether the property of `low` still holds at x.
template <class Holds>
Bracket bisect(Bracket b, int halvings, double width, const Holds& holds) {
  for (int k = 0; k < halvings && b.width() > width && b.contains(b.middle()); ++k) {
    const double middle = b.middle();
    (holds(middle) ? b.low : b.high) = middle;
  }
  return b;
}

/// Regula falsi after Dowell and Jarratt (1971), "Illinois", of a function that rises: f_low <= 0 < f_high. An end that stays twice
/// counts half, so that both close in. What is no number counts as low. Where `met(f(x))`, x is both ends of the result.
template <class Function, class Met>
Bracket illinois(Bracket b, double f_low, double f_high, int most, double width, const Function& f, const Met& met) {
  int side = 0;
  for (int k = 0; k < most && b.width() > width; ++k) {
    const double x = b.inside(f_low < 0 ? (b.low * f_high - b.high * f_low) / (f_high - f_low) : b.low);
    const double value = f(x);
    if (met(value)) return {x, x};
    if (std::isfinite(value) && value > 0) {
      b.high = x, f_high = value;
      if (side == 1) f_low *= 0.5;
      side = 1;
    } else {
      b.low = x;
      if (std::isfinite(value)) f_low = value;
      if (side == -1) f_high *= 0.5;
      side = -1;
    }
  }
  return b;
}

/// Newton on a function that rises, from x: a step that would leave the bracket goes to its middle, and so do later ones that are
/// not half as long as the one before. Over a root like that of sqrt(|x|) sign(x) they would go to and fro for ever. `at(x)` gives
/// value and slope. Ends at a step shorter than `close`, or a bracket no wider than `width`.
template <class At>
double newton(Bracket b, double x, int most, double width, double close, const At& at) {
  constexpr int kFree = 8;
  double last = b.width();
  for (int k = 0; k < most && b.width() > width; ++k) {
    const auto [value, slope] = at(x);
    (value < 0 ? b.low : b.high) = x;
    if (value == 0) break;
    double next = b.inside(slope > 0 ? x - value / slope : b.middle());
    if (k >= kFree && std::abs(next - x) > 0.5 * last) next = b.middle();
    last = std::abs(next - x);
    if (last < close) break;
    x = next;
  }
  return x;
}

}  // namespace engine::math
