// What things look like: plain data, no physics, no GL. Lengths in metres, angles in radians, colours linear RGB 0..1.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <initializer_list>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/geometry/hyper_ellipsoid.h"
#include "engine/geometry/triangle_mesh.h"
#include "engine/math/types.h"

namespace render {

using engine::Pose;
using engine::Vec3;
using Colour = std::array<float, 3>;

enum class MaterialKind { matte, paint, glass, lamp, rubber, metal, skin, cloth };

struct Material {
  std::string name;
  MaterialKind kind = MaterialKind::matte;
  Colour colour{0.6f, 0.6f, 0.6f};
  float roughness = 0.6f;  // [-] 0 mirror .. 1 chalk
  float opacity = 1.0f;    // [-] glass lets the rest through
};

/// Triangles to look at. Several parts, one material each. Flat arrays: xyz per vertex.
struct Mesh {
  struct Part {
    std::uint32_t first = 0;  // into indices
    std::uint32_t count = 0;
    int material = 0;  // into Mesh::materials
  };
  std::vector<float> positions;
  std::vector<float> normals;
  std::vector<std::uint32_t> indices;
  std::vector<Part> parts;
  std::vector<Material> materials;
  /// The same surface with fewer triangles, for where it is seen small; coarser from one to the next, part by part as above.
  struct Level {
    double tolerance = 0;  // [m] it stays this near
    std::vector<std::uint32_t> indices;
    std::vector<Part> parts;
  };
  /// Made when a picture first shows the mesh, as it costs more than a short run. Call it before work is split among processes.
  const std::vector<Level>& levels() const;
  mutable std::optional<std::vector<Level>> made_levels{};
};

/// Something that moves with one body of the Recording.
struct EllipsoidActor {
  std::string name;
  int body = 0;  // index into Snapshot::bodies
  engine::HyperEllipsoid shape;
  Material material;
};

struct MeshActor {
  std::string name;
  int body = 0;  // -1: stands still in the world
  Pose X_BM;     // mesh frame in the body frame
  std::shared_ptr<const Mesh> mesh;
  std::vector<Material> repaint;                        // replaces mesh materials of the same name (another paint colour)
  std::shared_ptr<const engine::TriangleMesh> solid{};  // what it is for touch, in the mesh frame; null: nothing
};

/// A wheel follows its WheelRecord (hub, steer, spin).
struct WheelActor {
  int vehicle = 0;
  int wheel = 0;
  int body = -1;  // of the vehicle: its attitude turns the wheel
  bool left = true;
  std::shared_ptr<const Mesh> mesh;  // axle along y, outside towards +y, centred at the hub
};

struct Skin;  // render/surface/skin.h

enum class PersonLook { segments, skin, raster };

/// The segments of one person, for the skin and for picking its look. X_WB is the pose the skin is built in.
struct PersonActor {
  struct Segment {
    std::string name;  // "head", "left_thigh" ...
    int body = 0;
    int parent = -1;              // index into segments: the one its joint hangs on
    Vec3 joint_P = Vec3::Zero();  // [m] that joint's centre in the parent's body frame
    engine::HyperEllipsoid shape;
    Pose X_WB;
    Material material;
  };
  std::string name;
  int mount = -1;  // body of what it rides
  PersonLook look = PersonLook::segments;
  std::vector<Segment> segments;

  /// For look `skin`: built when a picture first shows it, as it costs more than a short run, and shared by the actor's copies.
  /// Call it before work is split among processes.
  const std::shared_ptr<const Skin>& skin() const;
  std::shared_ptr<std::shared_ptr<const Skin>> built_skin = std::make_shared<std::shared_ptr<const Skin>>();
};

/// One closed surface over the segments that bends at the joints.
std::shared_ptr<const Skin> build_skin(const PersonActor&);

/// A picture that lies on the ground, an aerial photograph or a drawing to scale. Square texels.
struct GroundPicture {
  /// Texels as they are packed in a PNG, red lowest; the lowest row first. From one level to the next half the size.
  struct Level {
    int width = 0, height = 0;
    std::vector<std::int32_t> texels;
  };
  std::vector<Level> levels;
};
/// From a PNG; null where it cannot be read, and why.
std::shared_ptr<const GroundPicture> read_ground_picture(const std::filesystem::path&, std::string& problem);

struct RoadLook {
  bool road = true;  // asphalt with lane markings along x; false: plain ground with a metre grid
  double height = 0;
  double width = 7.0;  // [m] kerb to kerb, centred on `centre_y`
  double centre_y = 0;
  int lanes = 2;
  bool metre_grid = false;
  bool zebra = false;  // pedestrian crossing across the road at x = zebra_x
  double zebra_x = 0;
  std::shared_ptr<const Mesh> terrain;
  std::shared_ptr<const engine::TriangleMesh> terrain_surface;  // the same, for what lies on it
  std::shared_ptr<const GroundPicture> picture;
  double picture_x = 0, picture_y = 0;  // [m] of its lower left corner
  double picture_width = 0;             // [m] of its lower edge
  double picture_turn = 0;              // [rad] of its lower edge from +x towards +y
};

struct SkyLook {
  double sun_azimuth = 2.3;    // [rad] from +x towards +y, direction to the sun
  double sun_elevation = 0.8;  // [rad]
  double haze = 0.4;           // [-] 0 clear .. 1 fog
};

enum class CameraKind { fixed, follow, orbit, top, eye, path };

/// Where a moving camera is at one time; between knots it runs along a smooth curve.
struct CameraKnot {
  double time = 0;  // [s]
  Vec3 position{-8, -8, 3};
  Vec3 target{0, 0, 1};
};

struct Camera {
  std::string name;
  CameraKind kind = CameraKind::fixed;
  Vec3 position{-8, -8, 3};      // fixed: world; follow: offset from the followed point; eye: body axes of what it follows
  Vec3 target{0, 0, 1};          // fixed: world; follow, orbit, top: offset from the followed point; eye: body axes
  std::string follow;            // body, vehicle or person ("pedestrian" = its hips); empty: the world
  double vertical_fov = 0.7;     // [rad]
  double orbit_radius = 8;       // [m]
  double orbit_height = 2.5;     // [m]
  double orbit_start = 0;        // [rad]
  double orbit_rate = 0.3;       // [rad/s]
  double top_height = 14;        // [m] seen from bottom to top of the picture; orthographic
  double smoothing = 0.25;       // [s] a following camera averages its subject over this time
  std::vector<CameraKnot> path;  // path: at least two, times ascending; offsets where it follows something
};

/// How two cameras share the picture, on one clock.
enum class Layout { single, split, stacked, inset };

/// A stretch of film. `speed` 0.25 is four times slow motion; 0 freezes for `hold`.
struct Shot {
  std::string camera;
  double from = 0;  // [s] simulated time
  double to = 0;    // [s]
  double speed = 1;
  double hold = 0;  // [s] of film, for speed 0
  Layout layout = Layout::single;
  std::string second{};  // the other camera of a shared picture
  std::string title{};   // chapter in the video file; empty: the camera's name
};

/// A page of text before the first shot or after the last: title, assumptions.
struct Card {
  std::string title;
  std::vector<std::string> lines;
  double hold = 3;  // [s] of film
  bool at_end = false;
};

/// A line with its length in numbers, between two points or from where a body was to where it is.
struct Dimension {
  std::string label;
  int body = -1;     // -1: from `from` to `to`
  double since = 0;  // [s] where the body was then
  Vec3 from = Vec3::Zero();
  Vec3 to = Vec3::Zero();
};

enum class ContactColour { time, impulse };

/// A key of [overlays]: a switch, or a number.
struct OverlayKey {
  const char* name;
  double fallback;                                                    // SI; of a switch 0 or 1; of a number 0: none
  const char* doc;                                                    // a sentence
  const char* unit = "";                                              // SI; empty: a switch
  double lower = 0, upper = std::numeric_limits<double>::infinity();  // of a number, which is positive
};

/// Those of all overlays.
std::vector<OverlayKey> overlay_keys();

/// What is drawn over the picture. Switches and numbers go by their keys in [overlays]; each stands in the file of its overlay
/// (overlays/overlay.h). A key that no overlay has throws std::out_of_range.
class Overlays {
 public:
  Overlays();                                                                     // as of a scene that says nothing
  double of(std::string_view key) const { return values_.at(std::string(key)); }  // SI; 0: a number that is not given
  bool on(std::string_view key) const { return of(key) > 0; }
  void set(std::string_view key, double value = 1) { values_.at(std::string(key)) = value; }
  void hide(std::initializer_list<std::string_view> keys) {
    for (const std::string_view key : keys) set(key, 0);
  }

  std::vector<std::string> trace_bodies;
  ContactColour contact_colour = ContactColour::time;
  std::vector<Dimension> dimensions;

 private:
  std::map<std::string, double> values_;
};

/// Whose speed is told: a vehicle, a body, or a person, who moves as its centre of mass does.
struct Mover {
  int body = 0;                                  // of a person the hips
  std::string name;                              // readable
  std::vector<std::pair<int, double>> masses{};  // [kg] by body, of a person's parts; of all others empty
};

struct Stage {
  std::string title;
  std::string provenance;             // version, scene hash: small print at the foot
  std::vector<std::string> warnings;  // burnt into the caption (an effect forced off ...)
  std::vector<EllipsoidActor> ellipsoids;
  std::vector<MeshActor> meshes;
  std::vector<WheelActor> wheels;
  std::vector<int> vehicles;  // body of each, in the order of the recording
  std::vector<PersonActor> persons;
  RoadLook road;
  SkyLook sky;
  std::optional<double> north;  // [rad] from +x towards +y; unknown: top views show the x axis
  std::vector<Camera> cameras;  // never empty after loading
  std::vector<Shot> shots;      // empty: the whole run from the first camera at natural speed
  std::vector<Card> cards;
  Overlays overlays;
  std::vector<Mover> speeds;  // whose speed the caption tells
  std::map<int, Vec3> eyes;   // [m] of drivers, by the vehicle's body, in its axes
};

}  // namespace render
