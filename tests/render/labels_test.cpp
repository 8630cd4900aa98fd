// Panels of text: apart from each other, long ones, those that must be read, those beside somebody.
#include <gtest/gtest.h>

#include "render/arrange.h"
#include "render/matrix.h"
#include "render/text/charts.h"
#include "render/text/labels.h"
#include "tests/render/hand_made_stage.h"

namespace render {
namespace {

TEST(Labels, APageLargerThanThePictureIsWrittenSmaller) {
  DrawList list;
  LabelItem page;
  page.plate = false;
  page.anchor = {0.10f, 0.44f};
  page.pivot = {0, 0.5f};
  page.lines = {"Assumptions", std::string(300, 'm')};
  page.sizes = {58, 30};
  page.colours.resize(2);
  list.labels.push_back(page);
  const PanelBox box = place_labels(list, 1280, 720)[0];
  EXPECT_TRUE(box.shown);
  EXPECT_LT(box.shrink, 0.5);
  EXPECT_LE(box.x + box.width, 1280);
}

/// The caption holds the warning that something is switched off.
TEST(Labels, ThatMustBeReadAreBrokenAtWordsAndAlwaysShown) {
  DrawList list;
  LabelItem caption;
  caption.always = true;
  caption.anchor = {0.016f, 0.972f};
  caption.pivot = {0, 1};
  std::string speeds;
  for (int i = 0; i < 20; ++i) speeds += std::string(kItemGap) + "person 50.0 km/h";
  caption.lines = {"t = 1.000 s", speeds, "effect air_drag switched off by the author"};
  caption.sizes = {30, 22, 18};
  caption.colours.resize(3);
  list.labels.push_back(caption);
  for (const auto& [width, height] : {std::pair{1280, 720}, {540, 960}, {480, 480}, {320, 180}}) {
    const PanelBox box = place_labels(list, width, height)[0];
    EXPECT_TRUE(box.shown) << width;
    EXPECT_GE(box.x, 0) << width;
    EXPECT_LE(box.x + box.width, width);
    EXPECT_GE(box.y, 0) << width;
    EXPECT_LE(box.y + box.height, height);
  }
  EXPECT_EQ(place_labels(list, 1280, 720)[0].shrink, 1) << "two lines more are no reason to write smaller";
  list.reserved = {{0, 0, 1, 1}};
  EXPECT_TRUE(place_labels(list, 1280, 720)[0].shown) << "over what lies there";
}

TEST(Labels, ThatHaveALeaderKeepOffPersonsWhereThereIsRoom) {
  constexpr int kWidth = 1280, kHeight = 720;
  DrawList list;
  list.view.world_to_eye = list.view.eye_to_clip = to_gl(Mat4::Identity());  // one to a half of the frame
  LabelItem label;
  label.lines = {"left foot / sedan"};
  label.sizes = {20};
  label.colours = {{1, 1, 1, 1}};
  label.at_world_point = true;
  label.pivot = {0.5f, 0.5f};
  list.labels = {label};
  const auto place = [&] { return place_labels(list, kWidth, kHeight)[0]; };
  const PanelBox first = place();
  list.limbs = {{0, 0, 0, 0.05f}};
  EXPECT_EQ(place().y, first.y) << "beside what it speaks of";
  list.labels[0].leader = true;
  const PanelBox aside = place();
  EXPECT_TRUE(aside.shown);
  // the ball is 0.05 of 360 pixels high to either side of the middle
  EXPECT_LE(aside.y + aside.height, 360 - 18);
  EXPECT_GE(aside.y + aside.height, 360 - 18 - 0.35 * aside.height) << "no farther than it must";
  list.limbs = {{0, 0, 0, 1}};
  EXPECT_EQ(place().y, first.y) << "no room nearby";
  list.reserved = {{0.4f, 0.4f, 0.2f, 0.2f}};
  const PanelBox over = place();
  EXPECT_TRUE(over.shown);
  EXPECT_TRUE(over.y + over.height <= 0.4 * kHeight || over.y >= 0.6 * kHeight) << "rather over a person than over another panel";
}

TEST(Labels, NeverCoverEachOtherNorLeaveTheFrame) {
  Stage s = made_stage();
  for (const char* key : {"velocities", "legend", "contact_history", "speed_chart", "energy_chart"}) s.overlays.set(key);
  s.overlays.dimensions = {
      {"way", 0, 0.2}, {"", -1, 0, Vec3(0, 0, 0), Vec3(1, 0, 0)}, {"", -1, 0, Vec3(0, 0, 0), Vec3(1, 0.01, 0)}};
  for (const auto& [w, h] : {std::pair{1280, 720}, {640, 640}, {320, 180}, {64, 64}}) {
    const DrawList list = arrange(s, made_run(), {0.7, "side", 1}, static_cast<double>(w) / h);
    std::vector<PanelBox> boxes = place_labels(list, w, h);
    for (const ChartItem& chart : list.charts) {
      const auto [x, y, cw, ch] = chart_box(chart, w, h);
      boxes.push_back({x, y, cw, ch, true});
    }
    for (std::size_t i = 0; i < boxes.size(); ++i) {
      const PanelBox& a = boxes[i];
      if (!a.shown) continue;
      EXPECT_GE(a.x, 0);
      EXPECT_GE(a.y, 0);
      EXPECT_LE(a.x + a.width, w + 1e-9);
      EXPECT_LE(a.y + a.height, h + 1e-9);
      for (std::size_t k = 0; k < i; ++k) {
        const PanelBox& b = boxes[k];
        const bool apart = a.x >= b.x + b.width || b.x >= a.x + a.width || a.y >= b.y + b.height || b.y >= a.y + a.height;
        EXPECT_TRUE(!b.shown || apart) << w << "x" << h << " " << i << " " << k;
      }
    }
  }
}

}  // namespace
}  // namespace render
