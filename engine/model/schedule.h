// A quantity that may change during a run: the source's "dynamic parameters".
#pragma once

#include <vector>

namespace engine {

/// Piecewise linear in time, constant beyond both ends. One knot is a constant.
class Schedule {
 public:
  struct Knot {
    double time;   // [s]
    double value;  // in the unit of the quantity
  };
  Schedule(double constant) : knots_{{0, constant}} {}  // NOLINT: a plain number is a schedule
  explicit Schedule(std::vector<Knot> knots) : knots_(std::move(knots)) {}

  double at(double time) const {
    if (knots_.size() == 1 || time <= knots_.front().time) return knots_.front().value;
    for (std::size_t i = 1; i < knots_.size(); ++i) {
      if (time > knots_[i].time) continue;
      const Knot& p = knots_[i - 1];
      const Knot& q = knots_[i];
      if (q.time <= p.time) return q.value;
      return p.value + (q.value - p.value) * (time - p.time) / (q.time - p.time);
    }
    return knots_.back().value;
  }
  bool constant() const { return knots_.size() == 1; }
  const std::vector<Knot>& knots() const { return knots_; }

 private:
  std::vector<Knot> knots_;  // never empty, times ascending
};

}  // namespace engine
