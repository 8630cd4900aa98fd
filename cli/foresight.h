// What a run would tell too late: looked for in the scene before anything is computed at length.
#pragma once

#include <string>
#include <vector>

#include "engine/recording.h"
#include "render/frames.h"
#include "scenes/scene.h"

namespace cli {

/// Sentences without a place, most weighty first: overlaps and divergence in the first three steps, speeds no accident has, objects
/// that can touch nothing, accidents in which nothing touches, cameras that see nothing, a film larger than the disk has room for.
/// The film goes to `output`; empty: where `render` puts it by itself.
std::vector<std::string> foresee(const scenes::Scene&, const std::string& output);

/// Who stands inside a vehicle's shell touches nothing there, and a run of it begins without a word.
std::vector<std::string> inside_vehicles(const engine::Model&);

/// Riders whose hands or feet hold on to the air, or whose legs are too short for what they ride.
std::vector<std::string> unfit_riders(const engine::Model&);

/// Cards with more lines than a picture of that size has room for in letters that can be read.
std::vector<std::string> crowded_cards(const render::Stage&, int width, int height);

/// Whether a run that could have held a collision held none: no vehicle or person touched anything but the ground and itself.
bool nothing_touched(const engine::Model&, const engine::Recording&);

/// Names of what is fixed and wheels rolled over in a run: a bump, a kerb. That is road to them, and no contact is told of it.
std::vector<std::string> under_wheels(const engine::Model&, const engine::Recording&);

/// Whether the moment's picture, width / height = `aspect`, shows nothing of any vehicle, person or body.
bool is_empty_picture(const engine::Model&, const render::Stage&, const engine::Recording&, const render::Moment&, double aspect);

}  // namespace cli
