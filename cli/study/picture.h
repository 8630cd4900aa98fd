// `crashreel study --picture`: what the quality of a picture costs. Each knob of the renderer is turned alone, against a picture
// with sixteen times the samples, the finest shadows and the finest tessellation.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "engine/recording.h"
#include "render/arrange.h"
#include "render/charts/page.h"
#include "render/renderer.h"
#include "scenes/scene.h"

namespace cli::study {

struct PictureSetting {
  std::string series, label;
  render::Effort effort;
  double rms = 0;                                            // [1/255] against the reference
  double ssim = 1;                                           // structural similarity with it
  double frame_ms = 0, frame_low_ms = 0, frame_high_ms = 0;  // on one core, median and quartiles
  bool own = false;                                          // of the scene's quality
};

struct PictureStudy {
  render::Moment moment;
  int width = 0, height = 0;
  render::Effort reference;
  double reference_ms = 0;
  std::vector<PictureSetting> settings;
};

/// Draws the moment in this process. Throws RenderError.
PictureStudy study_picture(const scenes::Scene&, const engine::Recording&, const render::Moment&, int width, int height);

/// series,setting,scale,samples,shadow_map,shadow_filter,tessellation_px,rms_255,ssim,frame_ms
std::string picture_csv(const PictureStudy&);
nlohmann::ordered_json picture_json(const scenes::Scene&, const PictureStudy&);
std::string picture_text(const PictureStudy&);
render::charts::Page picture_page(const scenes::Scene&, const PictureStudy&);

}  // namespace cli::study
