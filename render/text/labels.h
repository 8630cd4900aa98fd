// Text panels on the finished picture.
#pragma once

#include <string>
#include <vector>

#include "render/draw_list.h"
#include "render/image/image.h"

namespace render {

/// A panel's place in the frame [pixels].
struct PanelBox {
  double x = 0, y = 0, width = 0, height = 0;
  bool shown = true;
  double shrink = 1;  // [-] of the writing: what would be larger than the picture
};

/// Where every label goes: kept inside the frame, moved aside from those before it, left out if there is no room and it need not be
/// shown always; one with a leader keeps off persons too where it can. Lines of a panel wider than the picture are broken at words.
/// Pure numbers.
std::vector<PanelBox> place_labels(const DrawList&, int width, int height);

/// The text in lines no wider than `width` [pixels], in letters of so many pixels: broken between words, within one that is wider.
std::vector<std::string> broken_at_words(const std::string& text, double pixels, double width);

/// Draws them, on translucent plates where they want one.
void draw_labels(const DrawList&, Image&);

}  // namespace render
