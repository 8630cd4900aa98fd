// Pages of text in a film: nothing of them leaves the picture, and no letter is too small to be read.
#include "render/card.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "render/text/labels.h"

namespace render {
namespace {

constexpr int kWidth = 640, kHeight = 360;
constexpr double kLeastPixels = 8;

CardPage page_of(const Card& card) {
  return card_page(Stage{}, card, kWidth, kHeight);
}

void expect_legible(const CardPage& page) {
  const std::vector<PanelBox> boxes = place_labels(page.list, kWidth, kHeight);
  for (const PanelBox& box : boxes) {
    EXPECT_TRUE(box.shown);
    EXPECT_EQ(box.shrink, 1);
    EXPECT_GE(box.x, 0);
    EXPECT_LE(box.x + box.width, 0.99 * kWidth) << "a margin at the right";
    EXPECT_GE(box.y, 0);
    EXPECT_LE(box.y + box.height, kHeight);
  }
  EXPECT_LE(boxes[0].y + boxes[0].height, boxes[1].y) << "the foot stands below";
  const LabelItem& text = page.list.labels[0];
  for (std::size_t i = 0; i < text.lines.size(); ++i) {
    const bool gap = text.lines[i] == " ";
    EXPECT_TRUE(gap || text.sizes[i] * kHeight / 1080 > 0.999 * kLeastPixels) << text.sizes[i];
  }
}

Card with_lines(int count) {
  Card card{"Assumptions", {}, 3, false};
  for (int i = 0; i < count; ++i) card.lines.push_back("line " + std::to_string(i));
  return card;
}

TEST(CardPage, OfFewLinesIsWrittenInFullSize) {
  const CardPage page = page_of(with_lines(3));
  EXPECT_EQ(page.fitting, 3u);
  EXPECT_FLOAT_EQ(page.list.labels[0].sizes.back(), 30);
  expect_legible(page);
}

TEST(CardPage, WritesManyLinesSmallerAndLeavesOutWhatFindsNoRoom) {
  const CardPage some = page_of(with_lines(18));
  EXPECT_EQ(some.fitting, 18u);
  expect_legible(some);
  const CardPage page = page_of(with_lines(45));
  EXPECT_LT(page.fitting, 45u);
  EXPECT_GE(page.fitting, 18u);
  EXPECT_EQ(page.list.labels[0].lines.back(), "\u2026");
  expect_legible(page);
  EXPECT_EQ(page_of(with_lines(static_cast<int>(page.fitting))).fitting, page.fitting) << "as many by themselves have room";
}

TEST(CardPage, BreaksLongLinesAtWords) {
  Card card = with_lines(2);
  std::string words;
  for (int i = 0; i < 60; ++i) words += (i ? " " : "") + std::string("word") + std::to_string(i);
  card.lines.push_back(words);
  card.title = "A title that is far too long for one line of the picture and goes on below it, before the court";
  const CardPage page = page_of(card);
  EXPECT_EQ(page.fitting, 3u);
  expect_legible(page);
  const std::vector<std::string>& lines = page.list.labels[0].lines;
  EXPECT_GT(lines.size(), 6u);
  std::string joined;
  for (const std::string& line : lines)
    if (line.starts_with("word")) joined += (joined.empty() ? "" : " ") + line;
  EXPECT_EQ(joined, words);
}

}  // namespace
}  // namespace render
