// Report figures: vector drawings to scale and over time (PDF and SVG), stills made of several moments (PNG). Every one reads in
// black and white: what colour tells, shape, dashes or lightness tell too.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "engine/recording.h"
#include "render/renderer.h"
#include "render/stage.h"

namespace render {

/// A phase of a throw as measured.
struct PhaseFacts {
  std::string name;
  double from = 0, to = 0;  // [s]
  double distance = 0;      // [m] along the line of the throw
};

/// What a recording alone does not tell of a person: masses, and the times between which its throw is measured.
struct PersonFacts {
  std::string name;
  std::vector<int> bodies;                                 // root first
  std::vector<double> masses;                              // [kg] of each
  std::optional<double> hit, landed, rest;                 // [s]
  std::optional<double> released;                          // [s] when the flight began
  std::vector<PhaseFacts> phases;                          // of the throw, in order
  bool dragged = false;                                    // a vehicle pushed it on as it slid
  int vehicle_body = -1;                                   // that struck
  std::vector<std::pair<std::string, double>> dimensions;  // [m] "throw distance", "airborne", ... as measured
};

struct FigureJob {
  std::filesystem::path folder;
  int width = 1920, height = 1080;  // of stills
  Quality quality = Quality::standard;
  std::vector<PersonFacts> persons;
  std::size_t person = 0;            // whom a figure of one person shows
  std::string name_after;            // of the name of its files
  std::vector<std::string> impacts;  // a line each, as measured
  std::map<std::string, std::string> metadata;
};

/// Each returns the files it wrote: none where the run has nothing to show. Throws RenderError.
std::vector<std::string> site_diagram(const Stage&, const engine::Recording&, const FigureJob&);
/// Of one person: without what other persons touched.
std::vector<std::string> contact_map(const Stage&, const engine::Recording&, const FigureJob&);
std::vector<std::string> vehicle_histories(const Stage&, const engine::Recording&, const FigureJob&);
std::vector<std::string> time_histories(const Stage&, const engine::Recording&, const FigureJob&);
std::vector<std::string> stroboscopic_still(const Stage&, const engine::Recording&, const FigureJob&);
/// Of one person, who is followed.
std::vector<std::string> contact_sheet(const Stage&, const engine::Recording&, const FigureJob&);

/// The nine instants of a contact sheet, in order: six from the person's first touch to the landing, three from there to the end;
/// nine evenly where there is none.
std::vector<double> times_of_sheet(const engine::Recording&, const FigureJob&);

/// Follows the person on the side from which more of it is seen until it lands: vehicles may stand between.
Camera camera_of_sheet(const Stage&, const engine::Recording&, const PersonFacts&);

/// The stage of a stroboscopic still: each vehicle that nobody rides as it stood at `met`, and clear as at `end`, where in full it
/// would hide who was there before.
Stage stage_of_stroboscope(const Stage&, const engine::Recording&, double met, double end);

/// When the vehicles of a site diagram stood where their dashed outlines are: as the first person was touched, else as two of
/// them first met, else at the start.
double dashed_at(const engine::Recording&, const FigureJob&);

/// Centre of mass of a person at a time.
Vec3 centre_of_mass(const PersonFacts&, const engine::Recording&, double time);

}  // namespace render
