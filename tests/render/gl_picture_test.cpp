// Pictures by the renderer against geometry: silhouettes, shadows, and the promise that a frame depends on its list alone.
#include <gmock/gmock.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "gl_scene.h"
#include "render/renderer.h"

namespace render {
namespace {

using namespace test;

constexpr int kWidth = 480, kHeight = 320;
constexpr float kAspect = 1.5f;

std::array<int, 3> pixel(const Image& image, int x, int y) {
  const std::size_t at = 4 * static_cast<std::size_t>(y * image.width + x);
  return {image.rgba[at], image.rgba[at + 1], image.rgba[at + 2]};
}

// red stands out from grey road and pale sky, in light and in shade
bool is_ball(const Image& image, int x, int y) {
  const auto [r, g, b] = pixel(image, x, y);
  return r > g + 25 && r > b + 25;
}

struct Span {
  int first = 100000, last = -1;
};
Span ball_columns(const Image& image) {
  Span s;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x)
      if (is_ball(image, x, y)) s.first = std::min(s.first, x), s.last = std::max(s.last, x);
  return s;
}

int brightness(const Image& image, int x, int y) {
  const auto [r, g, b] = pixel(image, x, y);
  return r + g + b;
}

Image draw_with(Renderer& renderer, const DrawList& list) {
  Image out;
  renderer.draw(list, out);
  return out;
}

TEST(Silhouette, OfABallHasTheWidthAndPlaceOfItsTangentCone) {
  // seen from the middle of its height, a ball of radius r at lateral offset x and depth d: its horizontal section is a circle,
  // whose tangents from the eye make the angles atan(x / d) +- asin(r / sqrt(x^2 + d^2))
  const float tan_half = 0.35f;
  const double x = 0.8, d = 6, r = 0.5;
  DrawList list = plain(look_along_y({0, 0, 20}, tan_half, kAspect));
  list.ellipsoids.push_back(ball({static_cast<float>(x), static_cast<float>(d), 20}, r));
  Renderer renderer(kWidth, kHeight, Quality::standard);
  const Span seen = ball_columns(draw_with(renderer, list));
  const double middle = std::atan2(x, d), half = std::asin(r / std::hypot(x, d));
  const double focal = kHeight / 2.0 / static_cast<double>(tan_half);  // [pixels]
  const double left = kWidth / 2.0 + focal * std::tan(middle - half), right = kWidth / 2.0 + focal * std::tan(middle + half);
  // a pixel counts from about a third of its area red, so either edge is known to a pixel; radius and place are their half sum and
  // difference
  ASSERT_GE(seen.last, 0);
  EXPECT_NEAR((seen.last + 1 - seen.first) / 2.0, (right - left) / 2, 0.75);
  EXPECT_NEAR((seen.last + 1 + seen.first) / 2.0, (right + left) / 2, 0.75);
}

TEST(Silhouette, OfABallFromAboveIsTrueToScale) {
  DrawList list = plain(look_down(3, 60, 4, kAspect));
  list.ellipsoids.push_back(ball({3.5f, 60, 1}, 0.5));
  Renderer renderer(kWidth, kHeight, Quality::standard);
  const Span seen = ball_columns(draw_with(renderer, list));
  const double scale = kHeight / 4.0;  // [pixels/m]
  ASSERT_GE(seen.last, 0);
  EXPECT_NEAR((seen.last + 1 - seen.first) / 2.0, 0.5 * scale, 0.75);
  EXPECT_NEAR((seen.last + 1 + seen.first) / 2.0, kWidth / 2.0 + 0.5 * scale, 0.75);
}

TEST(Shadow, LiesWhereTheSunPutsIt) {
  // the sun stands over +x at 45 degrees: what is at height h throws its shadow h towards -x
  DrawList list = plain(look_down(0, 60, 8, kAspect));
  list.sky.sun_azimuth = 0;
  list.sky.sun_elevation = std::atan(1.0);
  for (const float height : {0.4f, 2.0f}) {  // the upper one shows that what is nearest to the sun casts too
    SCOPED_TRACE(height);
    DrawList with = list;
    with.ellipsoids.push_back(ball({0, 60, height}, 0.3));
    with.ellipsoids.push_back(ball({0, 60, 0.4f}, 0.3));
    Renderer renderer(kWidth, kHeight, Quality::standard);
    const Image bare = draw_with(renderer, list), shaded = draw_with(renderer, with);
    const int y = kHeight / 2, at = kWidth / 2 - static_cast<int>(height * kHeight / 8.0f), mirror = kWidth - at;
    // the middle of the lower shadow may be hidden under the ball itself: look a third of a radius farther out
    const int out = at - (height < 1 ? 12 : 0);
    EXPECT_LT(brightness(shaded, out, y), 0.8 * brightness(bare, out, y));
    // on the sunny side, 2.0 m away, nothing changes but occlusion, which fades long before
    if (height > 1) {
      EXPECT_NEAR(brightness(shaded, mirror, y), brightness(bare, mirror, y), 12);
    }
  }
}

TEST(Frame, DependsOnItsListAlone) {
  DrawList one = plain(look_along_y({0, 0, 2}, 0.4f, kAspect));
  one.ellipsoids.push_back(ball({0.5f, 6, 0.5f}, 0.5));
  LineItem trace;
  trace.points = {{-2, 8, 0.5f}, {2, 8, 0.5f}};
  trace.occluded = render::Occluded::hidden;
  DrawList two = plain(look_down(1, 6, 9, kAspect));
  two.ellipsoids.push_back(ball({1, 6, 2}, 0.8));
  two.lines.push_back(trace);
  DrawList three = one;
  three.lines.push_back(trace);

  for (const Quality quality : {Quality::draft, Quality::standard}) {
    Renderer a(kWidth, kHeight, quality), b(kWidth, kHeight, quality);
    const Image first = draw_with(a, one), top = draw_with(a, two), traced = draw_with(a, three), again = draw_with(a, one);
    const Image b_traced = draw_with(b, three), b_top = draw_with(b, two), b_first = draw_with(b, one);
    EXPECT_TRUE(first.rgba == again.rgba) << "drawn twice";
    EXPECT_TRUE(first.rgba == b_first.rgba && top.rgba == b_top.rgba && traced.rgba == b_traced.rgba) << "drawn in another order";
    EXPECT_FALSE(first.rgba == traced.rgba) << "the line must be seen, else the comparison proves little";
  }
}

TEST(Marker, IsFaintBehindWhatStandsWellBeforeIt) {
  // at 6 m, with a ball of 0.5 m around 5.8 m before it, whose face is 0.7 m nearer, and around 6.1 m, 0.4 m nearer
  const auto blue_of = [](const DrawList& list) {
    Renderer renderer(kWidth, kHeight, Quality::standard);
    return pixel(draw_with(renderer, list), kWidth / 2, kHeight / 2)[2];
  };
  const DrawList empty = plain(look_along_y({0, 0, 2}, 0.4f, kAspect));
  for (const auto& [place, hides] : {std::pair(5.8f, true), std::pair(6.1f, false)})
    for (const Occluded occluded : {Occluded::shown, Occluded::faint}) {
      DrawList bare = empty;
      bare.ellipsoids.push_back(ball({0, place, 2}, 0.5));
      DrawList marked = bare;
      marked.markers.push_back({{0, 6, 2}, {1, 1, 1, 1}, 12, occluded});
      const int dark = blue_of(bare), seen = blue_of(marked);
      if (hides && occluded == Occluded::faint)
        EXPECT_NEAR(seen, dark + 0.25 * (255 - dark), 12);
      else
        EXPECT_GE(seen, 250);
    }
  // with nothing before it, and where there are no things at all
  DrawList alone = empty;
  alone.markers.push_back({{0, 6, 2}, {1, 1, 1, 1}, 12, Occluded::faint});
  EXPECT_GE(blue_of(alone), 250);
}

TEST(Line, IsSeenThroughAPaneByTheShareItLetsThrough) {
  DrawList pane = plain(look_along_y({0, 0, 2}, 0.4f, kAspect));
  pane.ellipsoids.push_back(ball({0, 4, 2}, 0.5));
  pane.ellipsoids[0].material.kind = MaterialKind::glass;
  pane.ellipsoids[0].material.opacity = 0.25f;  // one sample of four
  DrawList marked = pane;
  LineItem line;
  line.points = {{-1, 6, 2}, {1, 6, 2}};
  line.width = 24;
  line.outline = false;
  line.occluded = Occluded::hidden;
  marked.lines.push_back(line);
  Renderer renderer(kWidth, kHeight, Quality::standard);
  const int bare = pixel(draw_with(renderer, pane), kWidth / 2, kHeight / 2)[2];
  const int seen = pixel(draw_with(renderer, marked), kWidth / 2, kHeight / 2)[2];
  EXPECT_NEAR(seen, bare + 0.75 * (255 - bare), 2) << "two roundings";
}

TEST(Line, OfManyPiecesIsTheLineOfOne) {
  // half clear, with its outline: a pixel that two pieces paint stands out like a bead
  const auto drawn = [](int pieces) {
    DrawList list = plain(look_along_y({0, 0, 2}, 0.4f, kAspect));
    LineItem line;
    line.colour = {1, 1, 1, 0.5f};
    line.width = 24;
    for (int i = 0; i <= pieces; ++i) {
      const float s = static_cast<float>(i) / static_cast<float>(pieces);
      line.points.push_back({-2 + 4 * s, 6, 1.2f + 1.4f * s});
    }
    list.lines.push_back(line);
    Renderer renderer(kWidth, kHeight, Quality::draft);
    return draw_with(renderer, list);
  };
  const Image one = drawn(1), many = drawn(60);
  int worst = 0;
  for (std::size_t i = 0; i < one.rgba.size(); ++i) worst = std::max(worst, std::abs(int{one.rgba[i]} - int{many.rgba[i]}));
  // places of some hundred pixels in single precision: an edge lies 1e-4 pixels off, which rounds to a step of two layers at most
  EXPECT_LE(worst, 2);
}

TEST(Line, ThatIsThinIsAsDenseEverywhere) {
  // falls by three rows over the picture: a third of a pixel wide, it would come and go with each
  const DrawList empty = plain(look_along_y({0, 0, 2}, 0.4f, kAspect));
  DrawList lined = empty;
  LineItem line;
  line.width = 1;
  line.outline = false;
  line.points = {{-3, 6, 2}, {3, 6, 2.045f}};
  lined.lines.push_back(line);
  Renderer renderer(kWidth, kHeight, Quality::draft);
  const Image bare = draw_with(renderer, empty), painted = draw_with(renderer, lined);
  int least = 1000, most = 0;
  for (int x = kWidth / 4; x < 3 * kWidth / 4; ++x) {
    double share = 0;  // of a pixel that is painted in this column
    for (int y = 0; y < kHeight; ++y) {
      const int before = pixel(bare, x, y)[1];
      share += static_cast<double>(pixel(painted, x, y)[1] - before) / (255 - before);
    }
    least = std::min(least, static_cast<int>(1000 * share));
    most = std::max(most, static_cast<int>(1000 * share));
  }
  // a pixel of paint in each column; two roundings to 8 bits, of a ground that leaves 100 steps
  EXPECT_GT(least, 970);
  EXPECT_LT(most, 1030);
}

TEST(Line, ThatBendsIsNowhereDenserThanItsPaint) {
  const DrawList empty = plain(look_along_y({0, 0, 2}, 0.4f, kAspect));
  DrawList bent = empty;
  LineItem line;
  line.colour = {1, 1, 1, 0.5f};
  line.width = 24;
  line.outline = false;
  for (int i = 0; i <= 60; ++i) {
    const float angle = 0.08f * static_cast<float>(i);
    line.points.push_back({1.2f * std::cos(angle), 6, 2 + 1.2f * std::sin(angle)});
  }
  bent.lines.push_back(line);
  Renderer renderer(kWidth, kHeight, Quality::draft);
  const Image bare = draw_with(renderer, empty), painted = draw_with(renderer, bent);
  int seen = 0;
  for (std::size_t i = 0; i < bare.rgba.size(); ++i) {
    ASSERT_LE(painted.rgba[i], bare.rgba[i] + 0.5 * (255 - bare.rgba[i]) + 2) << "rounded twice";
    seen += painted.rgba[i] > bare.rgba[i];
  }
  EXPECT_GT(seen, 1000);
}

TEST(Frame, OfAStandingCameraDoesNotDependOnTheOnesBefore) {
  // the background is kept from the second frame on, and what moves is drawn over it
  DrawList list = plain(look_along_y({0, 0, 2}, 0.4f, kAspect));
  auto with_ball_at = [&](float x) {
    DrawList out = list;
    out.ellipsoids.push_back(ball({x, 6, 0.5f}, 0.5));
    return out;
  };
  for (const Quality quality : {Quality::draft, Quality::standard, Quality::fine}) {
    Renderer renderer(kWidth, kHeight, quality);
    for (const float x : {-1.0f, 0.0f, 1.0f}) {
      const Image in_a_row = draw_with(renderer, with_ball_at(x));
      Renderer fresh(kWidth, kHeight, quality);
      EXPECT_TRUE(in_a_row.rgba == draw_with(fresh, with_ball_at(x)).rgba) << "ball at " << x;
    }
    // and without anything to draw again
    Renderer fresh(kWidth, kHeight, quality);
    EXPECT_TRUE(draw_with(renderer, list).rgba == draw_with(fresh, list).rgba);
  }
}

TEST(Mesh, OfWhateverWindingIsLitOnTheSideThatIsSeen) {
  // a plate facing the camera and the sun, wound one way and the other
  auto plate = [](bool turned) {
    auto mesh = std::make_shared<Mesh>();
    mesh->positions = {-1, 5, 1, 1, 5, 1, 1, 5, 3, -1, 5, 3};
    mesh->indices = turned ? std::vector<std::uint32_t>{0, 2, 1, 0, 3, 2} : std::vector<std::uint32_t>{0, 1, 2, 0, 2, 3};
    for (int i = 0; i < 4; ++i) mesh->normals.insert(mesh->normals.end(), {0.0f, turned ? 1.0f : -1.0f, 0.0f});
    mesh->parts = {{0, 6, 0}};
    mesh->materials = {Material{}};
    MeshItem item;
    item.mesh = mesh;
    item.model = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
    item.materials = mesh->materials;
    return item;
  };
  DrawList list = plain(look_along_y({0, 0, 2}, 0.4f, kAspect));
  list.sky.sun_azimuth = -1.4;
  Renderer renderer(kWidth, kHeight, Quality::standard);
  DrawList turned = list;
  list.meshes.push_back(plate(false));
  turned.meshes.push_back(plate(true));
  const Image one = draw_with(renderer, list), other = draw_with(renderer, turned);
  EXPECT_NEAR(brightness(one, kWidth / 2, kHeight / 2), brightness(other, kWidth / 2, kHeight / 2), 3);
  EXPECT_GT(brightness(one, kWidth / 2, kHeight / 2), 3 * 120) << "the sun shines on it";
}

}  // namespace
}  // namespace render
