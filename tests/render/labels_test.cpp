// Panels of text that are long, must be read, or stand beside somebody.
#include <gtest/gtest.h>

#include "render/matrix.h"
#include "render/text/labels.h"

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

}  // namespace
}  // namespace render
