// What a player can show of a film besides its pictures: chapters to jump to, subtitles that can be switched off.
#pragma once

#include <string>
#include <vector>

#include "engine/recording.h"
#include "render/frames.h"

namespace render {

/// A stretch of film with a text, in seconds of film.
struct Passage {
  double from = 0;
  double to = 0;
  std::string text;
};

struct Story {
  std::vector<Passage> chapters;   // one a shot or card, without gaps
  std::vector<Passage> subtitles;  // what happens when, never two at a time
};

/// Something that happened, in a reader's words: "collision: sedan and motorcycle, 13.9 m/s".
struct Told {
  double time = 0;  // [s]
  std::string text;
};

/// The recorded events but the release of who stood or rode. What a rider loses hold of within 50 ms is one of them.
std::vector<Told> told(const engine::Recording&);

/// The story of these frames: a chapter where the shot changes, a subtitle where a recorded event is passed.
Story story_of(const Stage&, const engine::Recording&, const Film&, double fps);

}  // namespace render
