// A moment of the film as a picture: one camera, two on one clock, or a page of text.
#pragma once

#include <map>
#include <memory>
#include <utility>
#include <vector>

#include "render/arrange.h"
#include "render/image/image.h"
#include "render/renderer.h"

namespace render {

/// Where a camera's picture lies in the whole [pixels].
struct Pane {
  int x = 0, y = 0, width = 0, height = 0;
};

/// The first camera's pane and the second's; the second may lie upon the first. One pane for Layout::single.
std::vector<Pane> panes_of(Layout, int width, int height);

class Painter {
 public:
  Painter(int width, int height, Quality quality) : width_(width), height_(height), quality_(quality) {}
  /// Pure: the same moment gives the same bytes, whatever was painted before.
  void paint(const Stage&, const engine::Recording&, const Moment&, Image& out);
  /// Of the last picture, all its panes together.
  const FrameCost& cost() const { return cost_; }

 private:
  void paint_panes(const Stage&, const engine::Recording&, const Moment&, Image& out);
  Renderer& renderer(int width, int height);

  int width_, height_;
  Quality quality_;
  std::map<std::pair<int, int>, std::unique_ptr<Renderer>> renderers_;  // by size
  FrameCost cost_{};
};

}  // namespace render
