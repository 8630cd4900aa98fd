// Writing on paper: names that are longer than their place, and letters the font lacks.
#include "render/figures/sheet.h"

#include <gtest/gtest.h>

#include "render/text/fonts.h"

namespace render {
namespace {

TEST(Sheet, ShortensANameInItsMiddle) {
  cairo_surface_t* surface = cairo_image_surface_create(CAIRO_FORMAT_A8, 1, 1);
  cairo_t* c = cairo_create(surface);
  EXPECT_EQ(shortened(c, "car", 2.8, 40), "car");
  // two persons whose long names differ at the end, in letters of one and of two bytes
  const std::string hips = shortened(c, "Fußgängerin_aus_der_Ölmühle_mit_Einkaufstasche, hips", 2.8, 40);
  const std::string head = shortened(c, "Fußgängerin_aus_der_Ölmühle_mit_Einkaufstasche, head", 2.8, 40);
  EXPECT_LE(text_width(c, hips, 2.8), 40);
  EXPECT_GT(text_width(c, hips, 2.8), 30) << "as much of it as there is room for";
  EXPECT_NE(hips, head);
  EXPECT_TRUE(hips.starts_with("Fußg")) << hips;
  EXPECT_TRUE(hips.ends_with(", hips")) << hips;
  EXPECT_EQ(drawable(hips), hips) << "no letter is cut in two";
  cairo_destroy(c);
  cairo_surface_destroy(surface);
}

TEST(Fonts, NameLettersThatHaveNoGlyph) {
  EXPECT_EQ(without_glyph("Straße am Ölmühlenweg, \u03bc = 0.7, v\u2080\u00b2 \u2264 19"), "");
  EXPECT_EQ(without_glyph("\u4e8b\u6545\u518d\u73fe \u4e8b"), "\u4e8b\u6545\u518d\u73fe");
}

}  // namespace
}  // namespace render
