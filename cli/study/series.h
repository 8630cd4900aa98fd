// What a study varies: series of settings that trade accuracy for time. A setting is nothing but overrides of the scene, so what a
// study recommends can be pasted into it, and a series joins as soon as the scene format knows its keys.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "scenes/scene.h"

namespace cli::study {

struct Setting {
  std::string label;                   // "step 0.5 ms"
  std::vector<std::string> overrides;  // "simulation.step=0.5 ms", on top of those of the command line
  double fineness = 0;                 // falls towards 0 along the series: step [s], tolerance ...
  int members = 0;                     // perturbed runs besides the plain one
  bool own = false;                    // what the scene says now
  int start = 0;                       // draw of the start on its grid; 0: the scene's own
};

struct Series {
  std::string name;        // "stepping"
  std::string varies;      // "step", "tolerance" ...
  std::string meaning;     // for the reader of the page
  bool steps = false;      // a ladder of steps: its limit is an answer of its own
  bool other_law = false;  // another law of contact: its difference is modelling, not numerics
  std::vector<Setting> settings;
  double own_fineness = 0;  // of the scene, for series that vary something besides the step; 0: none of them is its own
};

struct StudyOptions {
  int members = 8;   // perturbed runs at a setting; the two costliest steps take fewer
  int halvings = 6;  // of the coarsest step
};

/// Tells whether the scene loads with these overrides.
using Accepts = std::function<bool(const std::vector<std::string>&)>;

inline constexpr const char* kSolverSeries = "solver tolerance";
inline constexpr const char* kStartsVary = "start";                 // what such a series varies
inline constexpr const char* kNotLocated = ", events not located";  // after the name of a scheme

/// True where the contact solver, with its tolerance, decides what contacts do.
bool solver_decides(const scenes::Scene&);

/// The series that mean something for the scene; the first is the ladder of its own scheme.
std::vector<Series> series_for(const scenes::Scene&, const StudyOptions&, const Accepts&);

}  // namespace cli::study
