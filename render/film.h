// Moments -> files: one forked worker a core draws, the parent encodes in order. Sub-ranges, stills and whole films use this one
// path.
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "engine/recording.h"
#include "render/arrange.h"
#include "render/renderer.h"
#include "render/stage.h"

namespace render {

enum class Container { mp4, png_sequence, single_png };

struct FilmJob {
  std::filesystem::path output;  // OUT.mp4, or a pattern like DIR/frame_%05d.png, or one PNG
  Container container = Container::mp4;
  int width = 1280;
  int height = 720;
  double fps = 30;
  int first_frame = 0;  // number of moments[0] in the whole film; a sub-range never moves the clock
  Quality quality = Quality::standard;
  int workers = 0;  // 0: one a core
  bool overwrite = false;
  std::map<std::string, std::string> metadata;  // provenance: title, version, scene_sha256 ...
};

struct FilmProgress {
  int frames_done = 0;
  int frames = 0;
};

/// Draws every moment and writes the files under temporary names, renamed when whole. Throws RenderError.
void make_film(const Stage&, const engine::Recording&, const std::vector<Moment>&, const FilmJob&,
               const std::function<void(const FilmProgress&)>& progress = {});

}  // namespace render
