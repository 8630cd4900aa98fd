// Cards, split screens and insets as pictures.
#include "render/painter.h"

#include <gtest/gtest.h>

#include "render/card.h"

namespace render {
namespace {

engine::Recording still() {
  engine::Recording r;
  r.body_names = {"ball"};
  r.snapshots.resize(1);
  r.snapshots[0].bodies.own().resize(1);
  r.snapshots[0].bodies.own()[0].X_WB.p = Vec3(0, 0, 1);
  return r;
}

/// A ball between two cameras, without a word.
Stage stage() {
  Stage s;
  EllipsoidActor ball;
  ball.shape = {Vec3::Constant(0.5), 2};
  ball.material.colour = {0.8f, 0.05f, 0.05f};
  s.ellipsoids.push_back(ball);
  s.cameras.resize(2);
  s.cameras[0].name = "near";
  s.cameras[0].position = Vec3(0, -3, 1);
  s.cameras[1].name = "far";
  s.cameras[1].position = Vec3(0, -12, 1);
  s.overlays.hide({"caption", "disclaimer"});
  return s;
}

bool red(const Image& image, int x, int y) {
  const std::uint8_t* p = &image.rgba[static_cast<std::size_t>(4 * (y * image.width + x))];
  return p[0] > 2 * p[1] && p[0] > 2 * p[2];
}

int reds(const Image& image, const Pane& pane) {
  int n = 0;
  for (int y = pane.y; y < pane.y + pane.height; ++y)
    for (int x = pane.x; x < pane.x + pane.width; ++x) n += red(image, x, y);
  return n;
}

constexpr int kWidth = 160, kHeight = 90;

TEST(PaintedPanes, EachShowItsCamerasPicture) {
  Painter painter(kWidth, kHeight, Quality::draft);
  for (const Layout layout : {Layout::split, Layout::stacked, Layout::inset}) {
    Image image;
    painter.paint(stage(), still(), {0, "near", 1, layout, "far"}, image);
    ASSERT_EQ(image.rgba.size(), static_cast<std::size_t>(4 * kWidth * kHeight));
    const auto panes = panes_of(layout, kWidth, kHeight);
    const int large = reds(image, panes[0]), small = reds(image, panes[1]);
    EXPECT_GT(small, 3) << "the ball far away";
    EXPECT_GT(large, 5 * small) << "the ball at hand, four times as wide";
  }
}

TEST(PaintedPanes, AreTheSameWhateverWasPaintedBefore) {
  const Moment split{0, "near", 1, Layout::split, "far"}, single{0, "far", 1};
  Painter used(kWidth, kHeight, Quality::draft), fresh(kWidth, kHeight, Quality::draft);
  Image a, b, c;
  used.paint(stage(), still(), split, a);
  used.paint(stage(), still(), single, b);
  used.paint(stage(), still(), split, b);
  fresh.paint(stage(), still(), split, c);
  EXPECT_EQ(a.rgba, b.rgba);
  EXPECT_EQ(a.rgba, c.rgba);
}

TEST(PaintedCard, IsAPageOfTextThatSaysItIsASimulation) {
  Stage s = stage();
  s.cards = {{"Assumptions", {"dry road"}, 1, false}};
  Moment moment{0, "near", 1};
  moment.card = 0;
  constexpr int kPageWidth = 640, kPageHeight = 360;  // large enough for letters
  Painter painter(kPageWidth, kPageHeight, Quality::draft);
  Image image;
  painter.paint(s, still(), moment, image);
  EXPECT_EQ(reds(image, {0, 0, kPageWidth, kPageHeight}), 0) << "no scene behind it";
  int light = 0;
  for (std::size_t i = 0; i < image.rgba.size(); i += 4) light += image.rgba[i] > 150;
  EXPECT_GT(light, 40) << "letters";
  EXPECT_EQ(card_page(s, s.cards[0], kPageWidth, kPageHeight).list.labels.back().lines[0], "Simulation, not footage");
}

}  // namespace
}  // namespace render
