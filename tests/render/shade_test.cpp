// The light comes out the same whatever the processor, and the cheap kind of a tile shows what the dear one would.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <random>

#include "gl_scene.h"
#include "render/gl/ground_tiles.h"
#include "render/gl/materials.h"
#include "render/gl/noise.h"
#include "render/matrix.h"
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
    data = frame.data;
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

std::vector<std::uint8_t> background(const Kernels& by, const Street& street, int zone, int sun, int filter, bool near = false) {
  std::vector<std::uint8_t> out(4 * kWidth * kHeight);
  by.background(street.data, street.maps(filter), {8, 0, kWidth - 8, kHeight, zone, sun, near},
                {out.data(), kWidth, kHeight, kWidth});
  return out;
}

TEST(Shade, BackgroundIsTheSameOnEveryProcessor) {
  const Street street;
  for (int zone = 0; zone <= static_cast<int>(gl::Zone::grass); ++zone)
    for (int sun = 0; sun <= static_cast<int>(gl::Sun::open); ++sun)
      for (const int filter : {1, 2})
        for (const bool near : {false, true})
          EXPECT_EQ(background(kernels(), street, zone, sun, filter, near),
                    background(plain_kernels(), street, zone, sun, filter, near))
              << "zone " << zone << ", sun " << sun << ", filter " << filter << (near ? ", near" : "");
}

/// Triangles of all sizes and turns before a street's camera, some reaching behind it.
struct Heap {
  static constexpr int kTriangles = 400, kCorners = 3 * kTriangles, kRoom = kCorners + 7, kSamples = 2;
  explicit Heap(const Street& street) {
    std::mt19937 random(11);
    std::uniform_real_distribution<float> any(-1, 1);
    for (int t = 0; t < kTriangles; ++t) {
      const float at[] = {4 * any(random), t % 8 == 1 ? -6.0f : 3 + 4 * any(random), 1.5f + 2 * any(random)};
      const float size = t % 4 == 0 ? 0.02f : t % 4 == 1 ? 1.5f : 0.2f;
      for (int k = 0; k < 3; ++k)
        for (std::size_t i = 0; i < 3; ++i) {
          mesh[i].push_back(at[i] + size * any(random));
          mesh[3 + i].push_back(any(random));
        }
    }
    for (auto& list : mesh) list.resize(kRoom);
    const Matrix4 clip = to_gl(street.frame.world_to_clip);
    std::copy(clip.begin(), clip.end(), projection.model_to_clip);
    for (const int i : {0, 5, 10, 15}) projection.model_to_world[i] = 1;
    projection.half_width = kWidth * kSamples / 2.0f;
    projection.half_height = kHeight * kSamples / 2.0f;
  }
  struct Projected {
    std::vector<float> records = std::vector<float>(8 * kRoom), places = std::vector<float>(4 * kRoom);
    Corners corners() { return {records.data(), places.data()}; }
  };
  Projected projected(const Kernels& by) const {
    Projected out;
    by.project(projection,
               {kCorners, mesh[0].data(), mesh[1].data(), mesh[2].data(), mesh[3].data(), mesh[4].data(), mesh[5].data()},
               out.corners());
    return out;
  }
  std::vector<std::vector<float>> mesh = std::vector<std::vector<float>>(6);
  Projection projection{};
};

TEST(Shade, CornersAreTheSameOnEveryProcessor) {
  const Street street;
  const Heap heap(street);
  const Heap::Projected a = heap.projected(kernels()), b = heap.projected(plain_kernels());
  EXPECT_EQ(a.records, b.records);
  EXPECT_EQ(a.places, b.places);
  int scaled = 0, left = 0;
  for (std::size_t i = 0; i < Heap::kCorners; ++i) {
    const float *r = &a.records[8 * i], *place = &a.places[4 * i];
    const Eigen::Vector4d clip = street.frame.world_to_clip * Eigen::Vector4d(place[0], place[1], place[2], 1);
    // a corner is scaled to w = 1 and snapped to 1/64 of a sample, or stays as it is
    const double x = (clip[0] + clip[3]) * kWidth * Heap::kSamples / 2 * static_cast<double>(r[4]);
    if (r[3] == 1) {
      ++scaled;
      ASSERT_NEAR(static_cast<double>(r[0]), x, 0.5 / 64 + 2e-6 * std::abs(x));
      ASSERT_EQ(r[0] * 64, std::floor(r[0] * 64));
    } else {
      ++left;
      ASSERT_NEAR(static_cast<double>(r[0]), x, 1e-5 * (1 + std::abs(x)));
      ASSERT_EQ(r[4], 1);
    }
  }
  EXPECT_GT(scaled, Heap::kTriangles);
  EXPECT_GT(left, 0) << "some reach behind the camera";
}

TEST(Shade, SurfacesAreTheSameOnEveryProcessor) {
  const Street street;
  const Heap heap(street);
  Heap::Projected seen = heap.projected(kernels());
  std::vector<Triangle> triangles;
  std::vector<float> x, y;
  std::vector<std::int32_t> triangle;
  std::mt19937 random(3);
  std::uniform_real_distribution<float> any(0, 1);
  for (std::int32_t t = 0; t < Heap::kTriangles; ++t) {
    triangles.push_back({{3 * t, 3 * t + 1, 3 * t + 2}, t % 8 + (t % 3 == 0 ? 32768 : 0), 0, t % 2 ? 1.0f : -1.0f});
    const float* c[] = {&seen.records[24 * t], &seen.records[24 * t + 8], &seen.records[24 * t + 16]};
    if (c[0][3] != 1 || c[1][3] != 1 || c[2][3] != 1) continue;
    for (int i = 0; i < 5; ++i) {
      const float u = any(random), v = (1 - u) * any(random);
      x.push_back((c[0][0] + u * (c[1][0] - c[0][0]) + v * (c[2][0] - c[0][0])) / Heap::kSamples);
      y.push_back((c[0][1] + u * (c[1][1] - c[0][1]) + v * (c[2][1] - c[0][1])) / Heap::kSamples);
      triangle.push_back(t);
    }
  }
  const int count = static_cast<int>(x.size());
  ASSERT_GT(count, 1000);
  for (auto* list : {&x, &y}) list->resize(x.size() + 7);
  triangle.resize(triangle.size() + 7);
  triangles.push_back({});
  std::vector<float> materials;
  for (int kind = 0; kind < 8; ++kind) {
    Material m;
    m.kind = static_cast<MaterialKind>(kind);
    for (const Float4& four : gl::row_of(m, kind == 0)) materials.insert(materials.end(), four.begin(), four.end());
  }
  const auto lit = [&](const Kernels& by, bool terrain) {
    std::vector<std::vector<float>> out(3, std::vector<float>(triangle.size()));
    by.surfaces(street.data, street.maps(1), {materials.data(), triangles.data(), seen.corners(), Heap::kSamples, terrain},
                {count, x.data(), y.data(), triangle.data(), out[0].data(), out[1].data(), out[2].data()});
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
                       {out.data(), kWidth, kHeight, kWidth});
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
                           {part.data(), kWidth, kHeight, kWidth});
      for (int y = r.y; y < r.y + r.height; ++y)
        for (int i = 4 * (y * kWidth + std::max(r.x, 8)); i < 4 * (y * kWidth + r.x + r.width); ++i)
          // rounding, and the noise that the kernel with a horizon adds
          ASSERT_LE(std::abs(part[static_cast<std::size_t>(i)] - whole[static_cast<std::size_t>(i)]), 1)
              << "kind " << static_cast<int>(look.zone) << " at row " << y;
    }
  }
  EXPECT_GE(kinds, 4);
}

}  // namespace
}  // namespace render::shade
