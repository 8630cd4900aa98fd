// Where many runs of one scene end: the cloud of rest places with its regions, and some of the runs as pale figures.
#pragma once

#include <array>
#include <string>
#include <utility>
#include <vector>

#include "render/figures/figures.h"
#include "render/figures/outline.h"

namespace render {

/// The smallest region that holds a share of the runs, by its edge in pieces.
struct RestRegion {
  double share = 0.5;
  std::vector<std::array<Point2, 2>> edge;  // [m] world
};

struct RestCloud {
  std::string name;            // of the person, vehicle or body
  std::vector<Point2> places;  // [m] world, a run each
  std::size_t moving = 0;      // runs that ended before it came to rest, which are left out
  std::vector<RestRegion> regions;
};

/// A run other than the one that is drawn in full.
struct RestGhost {
  std::string label;  // "5 %: 8.1 m"
  engine::Snapshot end;
};

struct RestFigure {
  std::vector<RestCloud> clouds;
  std::vector<RestGhost> ghosts;
  std::string middle;  // label of the run drawn in full
};

/// The site from above as rest_cloud.pdf and .svg. `middle` is the run drawn in full.
std::vector<std::string> rest_cloud(const Stage&, const engine::Recording& middle, const FigureJob&, const RestFigure&);
/// The ends of these runs in one picture, rest_ghosts.png; none where nobody and nothing but vehicles moves.
std::vector<std::string> rest_ghosts(const Stage&, const engine::Recording& middle, const FigureJob&, const RestFigure&);

}  // namespace render
