// The visibility buffer: triangles that meet leave no sample out, and a band sees what the whole picture does.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "gl_scene.h"
#include "render/gl/context.h"
#include "render/gl/object_pass.h"

namespace render::gl {
namespace {

constexpr int kWidth = 150, kHeight = 110, kSamples = 2;

/// A sheet that fills the picture: spokes from a place in it to a frame beyond it.
std::shared_ptr<const Mesh> fan(double x, double z, int spokes) {
  auto mesh = std::make_shared<Mesh>();
  const auto add = [&mesh](double right, double up) {
    for (const double v : {right, 0.0, up}) mesh->positions.push_back(static_cast<float>(v));
  };
  add(x, z);
  for (int i = 0; i < spokes; ++i) {
    const double turn = 2 * std::numbers::pi * i / spokes;
    add(40 * std::cos(turn), 40 * std::sin(turn));
    const std::uint32_t k = static_cast<std::uint32_t>(i), n = static_cast<std::uint32_t>(spokes);
    mesh->indices.insert(mesh->indices.end(), {0, 1 + k, 1 + (k + 1) % n});
  }
  mesh->parts = {{0, static_cast<std::uint32_t>(mesh->indices.size()), 0}};
  mesh->materials = {Material{}};
  return mesh;
}

struct Drawn {
  explicit Drawn(const DrawList& list_in) : list(list_in) {
    std::vector<CasterBox> boxes;
    pieces = collect(list, geometry, materials, 0.2, kHeight, boxes);
    frame = set_up_frame(list, boxes, kWidth, kHeight, 64);
  }
  /// The numbers of the corners each sample of the band sees, by the place of the first.
  std::vector<float> seen(ObjectPass& pass, const Rectangle& band) {
    pass.draw(list, pieces, frame, kWidth, kHeight, kSamples, band);
    pass.read(band, kSamples);
    std::vector<float> out;
    for (int i = 0; i < band.width * band.height * kSamples * kSamples; ++i) {
      const std::int32_t name = pass.names()[i];
      const shade::Triangle& t = pass.triangles().described()[static_cast<std::size_t>(name)];
      for (int k = 0; k < 2; ++k) out.push_back(name == 0 ? -1 : pass.triangles().corners().records[8 * t.vertices[1] + k]);
    }
    return out;
  }
  DrawList list;
  GlContext context;
  GeometryCache geometry;
  MaterialTable materials;
  std::vector<Piece> pieces;
  FrameSetup frame;
};

DrawList picture_of(const std::shared_ptr<const Mesh>& mesh) {
  DrawList list = test::plain(test::look_along_y({0, -8, 3}, 0.3f, static_cast<float>(kWidth) / kHeight));
  list.view.eye[2] = -1;  // the ground hides nothing
  MeshItem item;
  item.mesh = mesh;
  item.model = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 3, 1};
  list.meshes = {item};
  return list;
}

TEST(Visibility, TrianglesThatMeetLeaveNoSampleOut) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> any(-1, 1);
  for (int round = 0; round < 12; ++round) {
    Drawn drawn(picture_of(fan(2 * any(random), 2 * any(random), 5 + 9 * round)));
    ObjectPass pass;
    for (const float v : drawn.seen(pass, {0, 0, kWidth, kHeight})) ASSERT_NE(v, -1) << "round " << round;
  }
}

TEST(Visibility, ABandSeesWhatTheWholePictureDoes) {
  DrawList list = picture_of(fan(0.3, 0.2, 37));
  list.meshes.front().model[13] = 3;  // behind balls
  std::mt19937 random(5);
  std::uniform_real_distribution<float> any(-1, 1);
  for (int i = 0; i < 20; ++i) list.ellipsoids.push_back(test::ball({2 * any(random), any(random), 3 + 2 * any(random)}, 0.3));
  list.ellipsoids[3].raster = true;
  list.ellipsoids[4].material.kind = MaterialKind::glass;
  list.ellipsoids[4].material.opacity = 0.5f;
  Drawn drawn(list);
  ObjectPass pass;
  const std::vector<float> whole = drawn.seen(pass, {0, 0, kWidth, kHeight});
  for (const int height : {7, 16, 33})
    for (int y = 0; y < kHeight; y += height) {
      const Rectangle band{11, y, kWidth - 30, std::min(height, kHeight - y)};
      const std::vector<float> part = drawn.seen(pass, band);
      for (int v = 0; v < band.height * kSamples; ++v)
        for (int u = 0; u < 2 * band.width * kSamples; ++u)
          ASSERT_EQ(part[static_cast<std::size_t>(v * 2 * band.width * kSamples + u)],
                    whole[static_cast<std::size_t>(((band.y * kSamples + v) * kWidth + band.x) * kSamples * 2 + u)])
              << "band from row " << y << ", " << u / 2 << ", " << v;
    }
}

}  // namespace
}  // namespace render::gl
