// Frames -> files: one forked worker a core draws, the parent encodes in order. Sub-ranges, stills and whole films use this one
// path.
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <string>

#include "engine/recording.h"
#include "render/cost.h"
#include "render/frames.h"
#include "render/renderer.h"
#include "render/stage.h"

namespace render {

enum class Container { mp4, mkv, png_sequence, single_png };  // H.264; FFV1, lossless; files of their own

constexpr bool is_video(Container c) {
  return c == Container::mp4 || c == Container::mkv;
}

struct FilmJob {
  std::filesystem::path output;  // OUT.mp4, or a pattern like DIR/frame_%05d.png, or one PNG
  Container container = Container::mp4;
  int width = 1280;
  int height = 720;
  double fps = 30;
  Quality quality = Quality::standard;
  int workers = 0;  // 0: one a core
  bool overwrite = false;
  std::map<std::string, std::string> metadata;  // provenance: title, version, scene_sha256 ...
  std::function<void()> look_around;            // called while waiting for a frame; ends the film by throwing
};

struct FilmProgress {
  int frames_done = 0;
  int frames = 0;
};

/// The file of frame `number` of the whole film, where the job makes pictures. Throws RenderError for a pattern without %0Nd.
std::filesystem::path frame_path(const FilmJob&, int number);
/// What a picture of this job says of itself.
std::map<std::string, std::string> frame_metadata(const FilmJob&, const Moment&);

/// Draws every frame and writes the files under temporary names, renamed when whole. Throws RenderError.
FilmCost make_film(const Stage&, const engine::Recording&, const Film&, const FilmJob&,
                   const std::function<void(const FilmProgress&)>& progress = {});

/// The film of the pictures that `drawn` made, the same to the byte as if it had been drawn at once. Throws RenderError.
void join_film(const Stage&, const engine::Recording&, const Film&, const FilmJob& drawn, const FilmJob&);

}  // namespace render
