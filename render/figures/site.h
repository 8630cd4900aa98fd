// What the parts of the site diagram share.
#pragma once

#include <cairo/cairo.h>

#include <array>
#include <string>
#include <vector>

#include "render/figures/figures.h"
#include "render/figures/plan.h"

namespace render {

constexpr double kKeyLetters = 2.9;  // [mm] of the key and of names

struct Site {
  const Stage& stage;
  const engine::Recording& recording;
  const FigureJob& job;
  Plan plan;
};

inline const engine::Pose& pose(const engine::Snapshot& s, int body) {
  return s.bodies[static_cast<std::size_t>(body)].X_WB;
}

/// No friction follows from a slide on which a vehicle pushed: the sheet says so where it gives its length.
std::string name_of_phase(const PersonFacts&, const std::string& phase);

/// The throw and its parts as dimensions, of all persons; numbers cover none of the others.
class ThrowLengths {
 public:
  ThrowLengths(cairo_t*, const Site&);
  void draw() const;
  /// [mm] that they reach on the paper.
  std::vector<Point2> reach() const;

 private:
  /// The length [m] that was measured between two points, on a line beside them, `offset` [mm] below on the paper.
  struct Length {
    Vec3 from, to;
    std::string text;
    double offset;
  };
  struct Line;
  Line line_of(const Length&) const;
  void draw(const Length&) const;
  std::vector<Length> lengths_of(const PersonFacts&) const;
  std::array<Point2, 2> place_of(const Length&) const;

  cairo_t* c_;
  const Site& site_;
  std::vector<Length> all_;
};

/// Where the front of each vehicle is, and its name, at `first` [s] and at the end; once where it stands for both.
void draw_vehicle_names(cairo_t*, const Site&, double first);

}  // namespace render
