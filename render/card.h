// A page of text in a film: its lines broken at words, written smaller where they are many, and never too small to be read.
#pragma once

#include <cstddef>

#include "render/draw_list.h"
#include "render/stage.h"

namespace render {

struct CardPage {
  DrawList list;
  std::size_t fitting = 0;  // lines of the card that are written: all, or what there is room for at the least size
};

CardPage card_page(const Stage&, const Card&, int width, int height);

}  // namespace render
