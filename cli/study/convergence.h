// What a ladder of steps says about the answer no step could give: observed order, limit, and a band for every level.
#pragma once

#include <string>
#include <vector>

namespace cli::study {

/// One run of a ladder, coarse to fine.
struct Level {
  double step = 0;         // [s], or any measure of fineness that falls to 0
  double value = 0;        // of one quantity
  bool comparable = true;  // false: the sequence of contacts is not that of the finest run
};

enum class Trust {
  steady,  // four levels or more fall with one order: Richardson value, grid-convergence band
  range,   // the order is not steady, or the sequence of contacts changes: only the range of the answers is honest
  exact,   // levels agree to rounding
};
const char* name_of(Trust);

struct Convergence {
  Trust trust = Trust::range;
  double order = 0;           // observed, NaN unless steady
  double limit = 0;           // Richardson value if steady, else the answer of the finest level
  int first = 0, last = 0;    // levels the order was fitted over, both included
  std::vector<double> error;  // value - limit, per level
  std::vector<double> band;   // half width that covers the limit, per level
  double beyond = 0;          // of a range: how far the limit may lie beyond the finest answer
};

/// At least two levels, coarse to fine, steps strictly falling.
/// value = limit + C step^order, order by least squares over the logarithms of the differences, in windows of four levels or more
/// that end at the finest level which differs by more than rounding. The longest window whose differences
/// fall with one order is taken. Band: 1.25 times the error where the order is steady (Roache 1994), with the misfit added (Eca and
/// Hoekstra 2014). Elsewhere: the distance to the farthest of all finer answers, at least of the three finest; where these still go
/// one way, with what their changes add up to if they go on falling.
Convergence converge(const std::vector<Level>& levels);
/// The same without an order.
Convergence range_only(const std::vector<Level>& levels);

constexpr double kSafety = 1.25;  // on an estimated error: Roache's factor where the order is known from more than two levels

}  // namespace cli::study
