// Where the runs of a sample end, for a plan of the site: clouds with the regions that hold half and nearly all of them.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "cli/inference/sample.h"
#include "render/figures/rest_cloud.h"

namespace cli::inference {

/// The smallest region that holds `share` of the places: where their density by a normal kernel is above the level that so many of
/// them exceed. Its edge in pieces; none for fewer than kFewestPlaces.
constexpr std::size_t kFewestPlaces = 20;
render::RestRegion region_of(const std::vector<render::Point2>& places, double share);
/// Whether a place lies in it: on the inner side of an odd number of its edges.
bool holds(const render::RestRegion&, const render::Point2&);

/// A cloud of every person, vehicle and free body whose rest place is not the same in all runs, of those in which it comes to
/// rest. Regions only of kFewestPlaces or more that were drawn, not chosen.
std::vector<render::RestCloud> clouds_of(const Table&);

/// Draws the runs nearest to the middle and the 5th and 95th percentile of the sample's main measure within the clouds, as
/// rest_cloud.pdf, rest_cloud.svg and rest_ghosts.png. Returns the files' names, none where nothing moves. Throws MachineError.
std::vector<std::string> draw_rests(const scenes::Scene&, const Prior&, const Sample&, const std::filesystem::path& folder);

}  // namespace cli::inference
