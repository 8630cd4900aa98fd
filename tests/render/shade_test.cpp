// The light comes out the same whatever the processor, and the cheap kind of a tile shows what the dear one would.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <random>

#include "gl_scene.h"
#include "render/gl/ground_tiles.h"
#include "render/gl/materials.h"
#include "render/gl/noise.h"
#include "render/shade/kernels.h"

namespace render::shade {
namespace {

constexpr int kWidth = 203, kHeight = 150, kMap = 64, kOcclusion = 16;

/// A street with something on it, and made-up maps.
struct Street {
  explicit Street(bool zebra = true, const View& view = test::look_along_y({0, -6, 2}, 0.25f, 1.35f)) {
    std::mt19937 random(7);
    std::uniform_real_distribution<float> any(0, 1);
    for (const std::uint8_t byte : gl::grain_picture()) grain.push_back(byte * 0x01010101u);
    for (float& d : depth) d = any(random) < 0.5f ? 1.0f : any(random);
    for (float& b : bounds) b = any(random);
    for (float& o : open) o = any(random);
    list.view = view;
    list.road.road = true;
    list.road.zebra = zebra;
    list.sky.haze = 0.4f;
    gl::CasterBox box;
    box.centre = {0, 1, 0.8};
    box.half_edges = Eigen::Matrix3d::Identity() * 0.8;
    frame = gl::set_up_frame(list, {box}, kWidth, kHeight, kMap);
    data = gl::frame_data(frame.block);
  }
  Maps maps(int filter) const {
    return {grain.data(), depth.data(), kMap, bounds.data(), 16, open.data(), kOcclusion, 0.05f, filter};
  }
  std::vector<std::int32_t> grain;
  std::vector<float> depth = std::vector<float>((kMap + 2) * (kMap + 2));
  std::vector<float> bounds = std::vector<float>(2 * 16 * 16);
  std::vector<float> open = std::vector<float>((kOcclusion + 2) * (kOcclusion + 2));
  DrawList list;
  gl::FrameSetup frame;
  FrameData data;
};

std::vector<std::uint8_t> background(const Kernels& by, const Street& street, int zone, int sun, int filter) {
  std::vector<std::uint8_t> out(4 * kWidth * kHeight);
  by.background(street.data, street.maps(filter), {3, 0, kWidth - 3, kHeight, zone, sun, false}, {out.data(), kWidth});
  return out;
}

TEST(Shade, BackgroundIsTheSameOnEveryProcessor) {
  const Street street;
  for (int zone = 0; zone <= static_cast<int>(gl::Zone::grass); ++zone)
    for (int sun = 0; sun <= static_cast<int>(gl::Sun::open); ++sun)
      for (const int filter : {1, 2})
        EXPECT_EQ(background(kernels(), street, zone, sun, filter), background(plain_kernels(), street, zone, sun, filter))
            << "zone " << zone << ", sun " << sun << ", filter " << filter;
}

TEST(Shade, SurfacesAreTheSameOnEveryProcessor) {
  const Street street;
  std::mt19937 random(11);
  std::uniform_real_distribution<float> any(0, 1);
  constexpr int kCount = 1003, kRoom = kCount + 7;
  std::vector<std::vector<float>> in(6, std::vector<float>(kRoom));
  for (auto& values : in)
    for (float& v : values) v = any(random);
  for (int i = 0; i < kRoom; ++i) {
    in[0][static_cast<std::size_t>(i)] *= kWidth;
    in[1][static_cast<std::size_t>(i)] *= kHeight;
    in[2][static_cast<std::size_t>(i)] = 0.9f + 0.1f * in[2][static_cast<std::size_t>(i)];
  }
  std::vector<std::int32_t> row;
  for (int i = 0; i < kRoom; ++i) row.push_back((i / 20 + i % 2) % 8 + (i % 3 == 0 ? 32768 : 0));
  std::vector<float> materials;
  for (int kind = 0; kind < 8; ++kind) {
    Material m;
    m.kind = static_cast<MaterialKind>(kind);
    for (const Float4& four : gl::row_of(m, kind == 0)) materials.insert(materials.end(), four.begin(), four.end());
  }
  const auto lit = [&](const Kernels& by, bool terrain) {
    std::vector<std::vector<float>> out(3, std::vector<float>(kRoom));
    by.surfaces(street.data, street.maps(1), materials.data(), terrain,
                {kCount, in[0].data(), in[1].data(), in[2].data(), in[3].data(), in[4].data(), in[5].data(), row.data(),
                 out[0].data(), out[1].data(), out[2].data()});
    return out;
  };
  for (const bool terrain : {false, true}) EXPECT_EQ(lit(kernels(), terrain), lit(plain_kernels(), terrain));
  const std::vector<std::vector<float>> colours = lit(kernels(), true);
  for (const float v : colours[1]) EXPECT_TRUE(v >= 0 && v <= 1.01f) << v;
}

TEST(Shade, APictureLiesOnTheGroundToScale) {
  Street street(false, test::look_down(0, 0, 8, 1.35f));
  // 2 x 2 texels of 1 m, turned a quarter: its lower edge points along +y
  const std::int32_t texels[] = {static_cast<std::int32_t>(0xff0000ffu), static_cast<std::int32_t>(0xff00ff00u),
                                 static_cast<std::int32_t>(0xffff0000u), 0};
  Maps maps = street.maps(1);
  maps.photograph.levels = 1;
  maps.photograph.texels[0] = texels;
  maps.photograph.width[0] = maps.photograph.height[0] = 2;
  maps.photograph.x = 1;
  maps.photograph.y = -1;
  maps.photograph.cosine = 0;
  maps.photograph.sine = 1;
  std::vector<std::uint8_t> out(4 * kWidth * kHeight);
  kernels().background(street.data, maps, {0, 0, kWidth, kHeight, static_cast<int>(gl::Zone::everything), 0, true},
                       {out.data(), kWidth});
  // 8 m are kHeight pixels
  const auto dominant = [&out](double x, double y) {
    const int i = static_cast<int>(kWidth / 2.0 + x * kHeight / 8), j = static_cast<int>(kHeight / 2.0 + y * kHeight / 8);
    const std::uint8_t* p = &out[4 * static_cast<std::size_t>(j * kWidth + i)];
    const int most = std::max({p[0], p[1], p[2]}), least = std::min({p[0], p[1], p[2]});
    return most - least < 40 ? 'n' : most == p[0] ? 'r' : most == p[1] ? 'g' : 'b';
  };
  EXPECT_EQ(dominant(0.7, -0.7), 'r') << "its first texel";
  EXPECT_EQ(dominant(0.7, 0.7), 'g') << "along its lower edge";
  EXPECT_EQ(dominant(-0.7, -0.7), 'b') << "the row above";
  EXPECT_EQ(dominant(-0.9, 0.9), 'n') << "transparent";
  EXPECT_EQ(dominant(1.3, 0), 'n') << "beyond its edge";
}

TEST(Shade, ATileOfOneKindShowsWhatTheWholePatternWould) {
  const Street street(false, test::look_down(0, -4.5f, 5, 1.35f));
  const gl::TileMap tiles = gl::lay_tiles(street.frame, street.list.road, gl::DepthPyramid(), gl::Shade::none, kWidth, kHeight);
  const std::vector<std::uint8_t> whole = background(kernels(), street, static_cast<int>(gl::Zone::everything), 0, 1);
  int kinds = 0;
  for (const auto& [look, rectangles] : tiles) {
    if (look.zone == gl::Zone::sky) continue;
    ++kinds;
    std::vector<std::uint8_t> part(4 * kWidth * kHeight);
    for (const gl::Rectangle& r : rectangles) {
      kernels().background(street.data, street.maps(1), {r.x, r.y, r.width, r.height, static_cast<int>(look.zone), 0, look.near},
                           {part.data(), kWidth});
      for (int y = r.y; y < r.y + r.height; ++y)
        for (int i = 4 * (y * kWidth + std::max(r.x, 3)); i < 4 * (y * kWidth + r.x + r.width); ++i)
          // rounding, and the noise that the shader with a horizon adds
          ASSERT_LE(std::abs(part[static_cast<std::size_t>(i)] - whole[static_cast<std::size_t>(i)]), 1)
              << "kind " << static_cast<int>(look.zone) << " at row " << y;
    }
  }
  EXPECT_GE(kinds, 4);
}

}  // namespace
}  // namespace render::shade
