// Writing on paper: names that are longer than their place, letters the font lacks, curves that look alike.
#include "render/figures/sheet.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "render/figures/figures.h"
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

/// Of a run in which so many bodies move.
std::string histories_of(int bodies) {
  const std::filesystem::path folder = std::filesystem::path(testing::TempDir()) / "histories";
  std::filesystem::create_directories(folder);
  Stage stage;
  engine::Recording recording;
  for (int b = 0; b < bodies; ++b) {
    recording.body_names.push_back("body" + std::to_string(b));
    stage.speeds.push_back({b, recording.body_names.back()});
  }
  for (int k = 0; k <= 50; ++k) {
    engine::Snapshot s;
    s.time = 0.02 * k;
    s.bodies.own().resize(static_cast<std::size_t>(bodies));
    for (engine::BodyState& body : s.bodies.own()) body.V_WB.v = {10, 0, 0};
    recording.snapshots.push_back(s);
  }
  FigureJob job;
  job.folder = folder;
  time_histories(stage, recording, job);
  std::ostringstream text;
  text << std::ifstream(folder / "time_histories.svg").rdbuf();
  std::filesystem::remove_all(folder);
  return text.str();
}

TEST(TimeHistories, MarkTheCurvesThatLineStylesDoNotTellApart) {
  const auto filled = [](const std::string& svg) {
    std::size_t count = 0;
    for (std::size_t at = 0; (at = svg.find("fill-rule", at)) != std::string::npos; ++at) ++count;
    return count;
  };
  const std::size_t six = filled(histories_of(6)), seven = filled(histories_of(7));
  ASSERT_FALSE(histories_of(6).empty());
  EXPECT_GE(seven, six + 5) << "the seventh has the dashes of the first";
}

}  // namespace
}  // namespace render
