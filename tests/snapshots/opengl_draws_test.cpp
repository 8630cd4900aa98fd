// OpenGL draws every picture: where a kind of its draw calls does nothing, that kind of thing is missing from the picture, and
// nothing else is. The program's glDrawArrays comes here first.
#include <gtest/gtest.h>

#include <cstdlib>
#include <utility>

#include "render/gl/gl.h"
#include "render/renderer.h"
#include "tests/render/gl_scene.h"

namespace {

using namespace render;

enum class Kind { none, things, shadows, marks, lines };
Kind lost = Kind::none;
decltype(render::glDrawArrays) draw_arrays = nullptr;

/// What the shaders in use draw, by what they are told of a corner.
Kind kind_of_call() {
  GLint program = 0;
  render::glGetIntegerv(GL_CURRENT_PROGRAM, &program);
  const auto told = [program](const char* attribute) {
    return render::glGetAttribLocation(static_cast<GLuint>(program), attribute) >= 0;
  };
  return told("number") ? Kind::things : told("mark") ? Kind::marks : told("tint") ? Kind::lines : Kind::shadows;
}

void draw_what_is_not_lost(GLenum mode, GLint first, GLsizei count) {
  if (kind_of_call() != lost) draw_arrays(mode, first, count);
}

constexpr int kWidth = 480, kHeight = 320;

/// From above: a ball with its shadow beside it, a mark to its left, a line to its right.
DrawList scene() {
  DrawList list = test::plain(test::look_down(0, 0, 8, 1.5f));
  list.sky.sun_azimuth = 0;
  list.sky.sun_elevation = 0.7;
  list.ellipsoids = {test::ball({0, 0, 1.2f}, 0.5)};
  StripItem strip;
  for (const float y : {-2.0f, 2.0f}) {
    strip.left.push_back({-4.2f, y, 0});
    strip.right.push_back({-3.8f, y, 0});
    strip.darkness.push_back(1);
  }
  list.strips = {strip};
  LineItem line;
  line.points = {{4, -1, 0.5f}, {4, 1, 0.5f}};
  line.colour = {0, 0, 1, 1};
  line.width = 24;
  list.lines = {line};
  return list;
}

struct Found {
  int things = 0, shadow = 0, mark = 0, line = 0;  // pixels
};

Found found(Kind without) {
  const DrawList list = scene();
  DrawList bare = list;
  bare.ellipsoids.clear(), bare.strips.clear(), bare.lines.clear();
  Renderer renderer(kWidth, kHeight, Quality::standard);
  draw_arrays = std::exchange(render::glDrawArrays, draw_what_is_not_lost);  // found anew with every context
  Image picture, ground;
  lost = Kind::none;
  renderer.draw(bare, ground);
  lost = without;
  renderer.draw(list, picture);
  lost = Kind::none;
  Found out;
  for (std::size_t at = 0; at < picture.rgba.size(); at += 4) {
    const std::uint8_t *p = &picture.rgba[at], *g = &ground.rgba[at];
    const int x = static_cast<int>(at / 4) % kWidth, darker = g[1] - p[1];
    out.things += p[0] > p[1] + 40;
    out.line += p[2] > p[1] + 100;
    if (p[0] > p[1] + 10 || p[2] > p[1] + 60) continue;  // their dark edges
    out.mark += darker > 25 && x < kWidth / 4;
    out.shadow += darker > 25 && x >= kWidth / 4;
  }
  return out;
}

TEST(OpenGlDraws, EverythingThereIs) {
  const Found all = found(Kind::none);
  EXPECT_GT(all.things, 1000);
  EXPECT_GT(all.shadow, 300);
  EXPECT_GT(all.mark, 500);
  EXPECT_GT(all.line, 300);
}

TEST(OpenGlDraws, Things) {
  const Found all = found(Kind::none), rest = found(Kind::things);
  EXPECT_EQ(rest.things, 0);
  EXPECT_GE(rest.shadow, all.shadow * 9 / 10);
  EXPECT_EQ(rest.mark, all.mark);
  EXPECT_EQ(rest.line, all.line);
}

TEST(OpenGlDraws, Shadows) {
  const Found all = found(Kind::none), rest = found(Kind::shadows);
  // the sky's light, which the ball keeps from the ground by a formula, stays away
  EXPECT_LT(rest.shadow, all.shadow / 2);
  EXPECT_GE(rest.things, all.things * 9 / 10);
  EXPECT_EQ(rest.mark, all.mark);
  EXPECT_EQ(rest.line, all.line);
}

TEST(OpenGlDraws, Marks) {
  const Found all = found(Kind::none), rest = found(Kind::marks);
  EXPECT_EQ(rest.mark, 0);
  EXPECT_EQ(rest.things, all.things);
  EXPECT_EQ(rest.shadow, all.shadow);
  EXPECT_EQ(rest.line, all.line);
}

TEST(OpenGlDraws, Lines) {
  const Found all = found(Kind::none), rest = found(Kind::lines);
  EXPECT_EQ(rest.line, 0);
  EXPECT_EQ(rest.things, all.things);
  EXPECT_EQ(rest.mark, all.mark);
}

}  // namespace
