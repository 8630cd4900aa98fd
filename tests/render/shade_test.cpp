// The light comes out the same whatever the processor, and the cheap kind of a tile shows what the dear one would.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <numbers>
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

TEST(Shade, MarksAreTheSameOnEveryProcessor) {
  const Street street;
  std::mt19937 random(11);
  std::uniform_int_distribution<std::int32_t> place(-64 * 40, 64 * 240);
  std::uniform_real_distribution<float> any(0, 1);
  std::vector<MarkTriangle> triangles(60);
  for (MarkTriangle& t : triangles)
    for (int k = 0; k < 3; ++k) {
      t.x[k] = place(random), t.y[k] = place(random);
      t.depth[k] = any(random), t.per_w[k] = 0.1f + any(random);
      t.across[k] = 2 * any(random) - 1, t.darkness[k] = any(random);
      t.place_x[k] = any(random), t.place_y[k] = any(random);
    }
  std::vector<float> depth(kWidth * kHeight + 7);
  for (float& d : depth) d = any(random);
  for (const float* held_against : {static_cast<const float*>(nullptr), static_cast<const float*>(depth.data())}) {
    std::vector<std::uint8_t> wide(4 * kWidth * kHeight, 200), plain = wide;
    const Marks list{triangles.data(), static_cast<int>(triangles.size()), 5, kHeight - 5, held_against};
    kernels().marks(street.maps(1), list, {wide.data(), kWidth, kHeight, kWidth});
    plain_kernels().marks(street.maps(1), list, {plain.data(), kWidth, kHeight, kWidth});
    EXPECT_EQ(wide, plain);
    EXPECT_NE(wide, std::vector<std::uint8_t>(wide.size(), 200)) << "nothing drawn";
  }
}

/// Triangles of all sizes and turns before a street's camera, on a grid of samples.
struct Heap {
  static constexpr int kTriangles = 400, kRoom = 3 * kTriangles + 7, kSamples = 2;
  explicit Heap(const Street& street, bool wires = false) {
    std::mt19937 random(11);
    std::uniform_real_distribution<float> any(-1, 1);
    for (int t = 0; t < kTriangles; ++t) {
      const float at[] = {4 * any(random), t % 8 == 1 ? -6.0f : 3 + 4 * any(random), 1.5f + 2 * any(random)};
      const float size = t % 4 == 0 ? 0.02f : t % 4 == 1 ? 1.5f : 0.2f;
      for (int k = 0; k < 3; ++k) {
        indices.push_back(static_cast<std::uint32_t>(3 * t + k));
        for (std::size_t i = 0; i < 3; ++i) {
          mesh[i].push_back(at[i] + size * any(random));
          mesh[3 + i].push_back(any(random));
        }
      }
    }
    for (auto& list : mesh) list.resize(kRoom);
    std::copy(street.frame.block.world_to_clip.begin(), street.frame.block.world_to_clip.end(), projection.model_to_clip);
    for (const int i : {0, 5, 10, 15}) projection.model_to_world[i] = run.model_to_world[i] = 1;
    projection.half_width = kWidth * kSamples / 2.0f;
    projection.half_height = kHeight * kSamples / 2.0f;
    run.indices = indices.data();
    run.triangles = kTriangles;
    run.closed = 1;
    run.kept = 13;
    run.above_ground = true;
    run.wires = wires;
    std::fill_n(run.axes, 3, 1.0f);
  }

  struct Seen {
    std::vector<float> depth = std::vector<float>(kWidth * kSamples * kHeight * kSamples + 7, 1.0f);
    std::vector<std::int32_t> names = std::vector<std::int32_t>(depth.size()), places = std::vector<std::int32_t>(2 * kRoom);
    std::vector<float> numbers = std::vector<float>(9 * kRoom), records = std::vector<float>(8 * kRoom);
    std::vector<Triangle> triangles = std::vector<Triangle>(kTriangles + 1);
    std::vector<std::int32_t> cut = std::vector<std::int32_t>(kTriangles);
    int count = 0, cut_count = 0;
    Projected vertices() {
      const auto n = [this](int i) { return numbers.data() + i * kRoom; };
      return {places.data(), places.data() + kRoom, n(0), n(1), n(2), n(3), n(4), n(5), n(6), n(7), n(8), records.data()};
    }
  };
  Seen seen(const Kernels& by) const {
    Seen out;
    by.project(projection,
               {3 * kTriangles, mesh[0].data(), mesh[1].data(), mesh[2].data(), mesh[3].data(), mesh[4].data(), mesh[5].data()},
               out.vertices());
    by.raster({out.depth.data(), out.names.data(), kWidth * kSamples, 0, 0, kWidth * kSamples, kHeight * kSamples}, out.vertices(),
              run, {out.triangles.data(), &out.count, out.cut.data(), &out.cut_count});
    return out;
  }
  std::vector<std::uint32_t> indices;
  std::vector<std::vector<float>> mesh = std::vector<std::vector<float>>(6);
  Projection projection{};
  Run run{};
};

TEST(Shade, TrianglesAreTheSameOnEveryProcessor) {
  const Street street;
  for (const bool wires : {false, true}) {
    const Heap heap(street, wires);
    const Heap::Seen a = heap.seen(kernels()), b = heap.seen(plain_kernels());
    EXPECT_EQ(a.depth, b.depth);
    EXPECT_EQ(a.names, b.names);
    EXPECT_EQ(a.places, b.places);
    EXPECT_EQ(a.numbers, b.numbers);
    EXPECT_EQ(a.records, b.records);
    EXPECT_EQ(a.cut, b.cut);
    ASSERT_EQ(a.count, b.count);
    EXPECT_GT(a.count, Heap::kTriangles / 3);
    EXPECT_GT(a.cut_count, 0) << "some reach behind the camera";
    for (int i = 0; i < a.count; ++i)
      EXPECT_EQ(std::memcmp(&a.triangles[static_cast<std::size_t>(i)], &b.triangles[static_cast<std::size_t>(i)], sizeof(Triangle)),
                0);
    const auto covered = std::count_if(a.depth.begin(), a.depth.end(), [](float z) { return z < 1; });
    EXPECT_GT(covered, kWidth * kHeight / (wires ? 10 : 2));
  }
}

TEST(Shade, SurfacesAreTheSameOnEveryProcessor) {
  const Street street;
  Heap heap(street);
  Heap::Seen seen = heap.seen(kernels());
  for (int i = 0; i < seen.count; ++i) seen.triangles[static_cast<std::size_t>(i)].row = i % 8 + (i % 3 == 0 ? 32768 : 0);
  std::vector<float> x, y, depth;
  std::vector<std::int32_t> triangle;
  for (std::size_t at = 0; at + 7 < seen.depth.size(); at += 7) {
    if (seen.depth[at] >= 1) continue;
    x.push_back((static_cast<float>(at % (kWidth * Heap::kSamples)) + 0.5f) / Heap::kSamples);
    y.push_back((static_cast<float>(at / (kWidth * Heap::kSamples)) + 0.5f) / Heap::kSamples);
    depth.push_back(seen.depth[at]);
    triangle.push_back(seen.names[at]);
  }
  const int count = static_cast<int>(x.size());
  ASSERT_GT(count, 1000);
  for (auto* list : {&x, &y, &depth}) list->resize(x.size() + 7);
  triangle.resize(triangle.size() + 7);
  std::vector<float> materials;
  for (int kind = 0; kind < 8; ++kind) {
    Material m;
    m.kind = static_cast<MaterialKind>(kind);
    for (const Float4& four : gl::row_of(m, kind == 0)) materials.insert(materials.end(), four.begin(), four.end());
  }
  const auto lit = [&](const Kernels& by, bool terrain) {
    std::vector<std::vector<float>> out(3, std::vector<float>(triangle.size()));
    by.surfaces(street.data, street.maps(1), {materials.data(), seen.triangles.data(), seen.vertices(), Heap::kSamples, terrain},
                {count, x.data(), y.data(), depth.data(), triangle.data(), out[0].data(), out[1].data(), out[2].data()});
    return out;
  };
  for (const bool terrain : {false, true}) EXPECT_EQ(lit(kernels(), terrain), lit(plain_kernels(), terrain));
  const std::vector<std::vector<float>> colours = lit(kernels(), true);
  for (const float v : colours[1]) EXPECT_TRUE(v >= 0 && v <= 1.01f) << v;
}

/// A fan around a point in the picture: who shares an edge shares no sample, and none is left out.
TEST(Shade, TrianglesThatMeetShareNoSampleAndLeaveNoneOut) {
  std::mt19937 random(5);
  std::uniform_real_distribution<float> any(0, 1);
  constexpr int kSide = 64, kSpokes = 23;
  for (int round = 0; round < 40; ++round) {
    // corners on the 1/64 grid, often in the middle of a sample
    const auto snapped = [&] {
      return static_cast<std::int32_t>(any(random) * (round % 2 ? 64 : 4096)) * (round % 2 ? 64 : 1) + 32;
    };
    std::vector<std::int32_t> x{snapped()}, y{snapped()};
    // around a frame beyond the picture
    for (int i = 0; i < kSpokes; ++i) {
      const double turn = 2 * std::numbers::pi * i / kSpokes;
      x.push_back(static_cast<std::int32_t>(2048 + 9000 * std::cos(turn)));
      y.push_back(static_cast<std::int32_t>(2048 + 9000 * std::sin(turn)));
    }
    std::vector<float> depth(x.size() + 7, 0.5f), per_w(x.size() + 7, 1.0f);
    x.resize(x.size() + 7);
    y.resize(y.size() + 7);
    std::vector<int> times(kSide * kSide, 0);
    for (std::uint32_t i = 0; i < kSpokes; ++i) {
      std::vector<float> seen(kSide * kSide + 7, 1.0f);
      const std::uint32_t corners[] = {0, 1 + i, 1 + (i + 1) % kSpokes};
      shade::Run run{};
      run.indices = corners;
      run.triangles = 1;
      int count = 0, cut_count = 0;
      std::int32_t cut = 0;
      Projected p{};
      p.x = x.data();
      p.y = y.data();
      p.depth = depth.data();
      p.per_w = per_w.data();
      kernels().raster({seen.data(), nullptr, kSide, 0, 0, kSide, kSide}, p, run, {nullptr, &count, &cut, &cut_count});
      for (std::size_t at = 0; at < times.size(); ++at) times[at] += seen[at] < 1 ? 1 : 0;
      for (std::size_t at = times.size(); at < seen.size(); ++at) ASSERT_EQ(seen[at], 1) << "beyond the grid";
    }
    for (const int n : times) ASSERT_EQ(n, 1) << "round " << round;
  }
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
          // rounding, and the noise that the shader with a horizon adds
          ASSERT_LE(std::abs(part[static_cast<std::size_t>(i)] - whole[static_cast<std::size_t>(i)]), 1)
              << "kind " << static_cast<int>(look.zone) << " at row " << y;
    }
  }
  EXPECT_GE(kinds, 4);
}

}  // namespace
}  // namespace render::shade
