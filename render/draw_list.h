// One frame, ready to draw: float, world space. Made by arrange (no GL), consumed by the renderer (no physics).
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "render/stage.h"

namespace render {

using Float3 = std::array<float, 3>;
using Float4 = std::array<float, 4>;
using Matrix4 = std::array<float, 16>;  // column-major, as GL wants it

inline constexpr const char* kItemGap = "     ";  // between what a line names one after the other: it is broken there first
inline constexpr Float4 kWhiteText{1, 1, 1, 1}, kPaleText{0.80f, 0.85f, 0.90f, 1};  // the first line of a label, the others

struct View {
  Matrix4 world_to_eye{};
  Matrix4 eye_to_clip{};
  Float3 eye{};
  bool orthographic = false;
  double vertical_extent = 0;  // [m] seen, orthographic only
};

/// A unit hyper-ellipsoid tessellation is chosen by the renderer from shape and size on the screen.
struct EllipsoidItem {
  engine::HyperEllipsoid shape;
  Matrix4 model{};  // rigid, body to world
  Material material;
  bool raster = false;  // wire grid
  std::uint32_t id = 0;
};

struct MeshItem {
  std::shared_ptr<const Mesh> mesh;
  Matrix4 model{};
  std::vector<Material> materials;  // one per mesh material, repainted
  std::uint32_t id = 0;
};

/// A surface whose vertices move every frame (the skin): positions and normals in world space, the rest constant.
struct SkinItem {
  std::shared_ptr<const Mesh> topology;  // indices, parts, materials
  std::vector<float> positions;
  std::vector<float> normals;
  std::vector<Material> materials;  // one per material of the topology, repainted; empty: as they are
};

/// What is drawn of a line, an arrow or a marker where something stands before it: all of it, a shade of it, nothing. What is
/// nearer to it than half a metre, as the limb that hides a contact of its own, does not stand before what would be faint.
enum class Occluded { shown, faint, hidden };

/// Anti-aliased line on top of the picture, width in pixels at 1080 lines. `outline` draws a dark edge.
struct LineItem {
  std::vector<Float3> points;
  Float4 colour{1, 1, 1, 1};  // sRGB, straight alpha
  float width = 2;
  bool outline = true;
  Occluded occluded = Occluded::shown;
  std::vector<Float3> normals;  // of the ground under each point, that it may lie on it with all its width; empty: it faces the eye
};

/// An arrow with a head of pixel size, from a to b.
struct ArrowItem {
  Float3 from{};
  Float3 to{};
  Float4 colour{1, 0.6f, 0.1f, 1};
  float width = 4;
  Occluded occluded = Occluded::shown;
};

/// A disc of pixel radius at a world point.
struct MarkerItem {
  Float3 at{};
  Float4 colour{1, 1, 1, 1};
  float radius = 4;
  Occluded occluded = Occluded::shown;
};

/// Decal on the ground: a strip such as a skid mark.
struct StripItem {
  std::vector<Float3> left;
  std::vector<Float3> right;
  std::vector<float> darkness;  // 0..1 along the strip
};

/// Screen-space text panel; anchor in 0..1 of the frame (0,0 top left), or beside a world point.
struct LabelItem {
  std::vector<std::string> lines;
  std::vector<float> sizes;  // pixels at 1080 lines, one per line
  std::vector<Float4> colours;
  bool at_world_point = false;
  Float3 world{};
  std::array<float, 2> anchor{0, 0};  // where in the frame
  std::array<float, 2> pivot{0, 0};   // which point of the panel sits there
  bool plate = true;                  // translucent plate behind
  bool leader = false;                // a line to the world point; the panel stands away from it, and from the limbs
  bool always = false;                // shown even where there is no room: smaller, or over others
};

/// A small diagram over time, drawn up to now.
struct ChartItem {
  struct Series {
    std::string name;
    Float4 colour{1, 1, 1, 1};
    std::vector<std::array<float, 2>> points;  // time [s], value
  };
  std::string title;  // with its unit
  std::vector<Series> series;
  int left_out = 0;                   // series there is no colour for
  double end = 1;                     // [s] of the time axis, from 0
  double ceiling = 1;                 // of the value axis, from 0
  double now = 0;                     // [s]
  std::array<float, 2> anchor{0, 0};  // where in the frame its pivot sits
  std::array<float, 2> pivot{0, 0};
  float width = 430, height = 240;  // pixels at 1080 lines
};

struct DrawList {
  View view;
  SkyLook sky;
  RoadLook road;
  std::vector<EllipsoidItem> ellipsoids;
  std::vector<MeshItem> meshes;
  std::vector<SkinItem> skins;
  std::vector<StripItem> strips;
  std::vector<LineItem> lines;
  std::vector<ArrowItem> arrows;
  std::vector<MarkerItem> markers;
  std::vector<LabelItem> labels;
  std::vector<ChartItem> charts;
  std::vector<Float4> limbs;                   // x, y, z, radius [m]: balls that persons lie within
  float scale = 1;                             // of text and lines: a pane's are as large as the whole picture's
  std::vector<std::array<float, 4>> reserved;  // x, y, width, height in 0..1 of the frame: no label may lie there
};

}  // namespace render
