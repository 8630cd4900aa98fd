// What the section readers work on: the scene as far as it is read, and where files are found. One reader a section of the file.
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "scenes/loader/bound.h"
#include "scenes/scene.h"

namespace scenes {

struct Builder {
  Scene scene;
  Errors errors;
  Errors assumed;                                                     // nothing wrong: what the scene left open
  std::filesystem::path folder;                                       // of the scene file
  std::map<std::string, std::shared_ptr<const ImportedMesh>> meshes;  // by path: those of this scene, each told of once

  std::string assets;  // hashes of the library files and meshes read, in order

  std::vector<std::string> declared;  // names of vehicles, persons and bodies in the file, read or not

  /// Whether a name, or the person it is a part of, stands in the file: an error in it was told already.
  bool is_declared(const std::string& name) const;
  std::map<std::string, engine::Vec3> hitches;    // by vehicle: where it tows, from its centre of mass
  std::map<std::string, engine::Vec3> saddles;    // by vehicle: centre of its rider's hips, from its centre of mass
  int body_index(const std::string& name) const;  // -1: no such body
  std::vector<std::string> body_names() const;
};

void read_settings(Builder&, std::optional<Reader>);
/// Sections that effects bring with them: their keys for the top of the file, and what they say, into Model::inputs.
std::vector<Key> keys_of_effects();
void read_inputs_of_effects(Builder&, Reader& scene);
void read_ground(Builder&, std::optional<Reader>);
void read_body(Builder&, Reader);
void read_joint(Builder&, Reader);
void read_impact(Builder&, Reader);
void read_person(Builder&, Reader);
void read_vehicle(Builder&, Reader);
/// Of a vehicle: the wheels, from its centre of mass `cg`, and what the driver does with this mass.
void read_wheels(Reader&, const engine::Vec3& cg, engine::Vehicle&);
void read_brake(Reader&, double mass, engine::Vehicle&);
void read_driver(Reader&, double mass, engine::Vehicle&);
void read_film(Builder&, Reader& scene);  // the four below, and output
void read_cameras(Builder&, Reader& scene);
void read_overlays(Builder&, Reader);
void read_road_and_sky(Builder&, Reader road, Reader sky);
void read_snapshot(Builder&, std::optional<Reader> snapshot, std::optional<Reader> expect);

extern const Section kSlideSection, kSimulationSection, kGroundSection, kBodySection, kJointSection, kImpactSection, kPersonSection,
    kVehicleSection;
extern const Section kWheelSection, kBrakeSection, kDriverSection, kPathSection;  // of a vehicle
extern const Section kCameraSection, kShotSection, kCardSection, kOverlaysSection, kOutputSection, kRoadSection, kSkySection;
extern const Section kSnapshotSection, kExpectSection;

// Shared by several sections.

/// Keys attitude or quaternion. Roll about x, then pitch about y, then yaw about z, all world axes.
struct Attitude {
  engine::Vec3 roll_pitch_yaw = engine::Vec3::Zero();  // [rad]
  std::optional<std::vector<double>> quaternion;       // [w, x, y, z]
};
engine::Quat read_attitude(Reader&);
/// Where on the ground a vehicle or person is at the start, and how it moves.
struct Placing {
  engine::Vec3 position = engine::Vec3::Zero();  // [m] world x, y
  double heading = 0;                            // [rad]
  double speed = 0;                              // [m/s] along the heading
  std::optional<engine::Vec3> velocity;          // [m/s] world, in place of speed

  engine::Vec3 ahead() const;
  /// Tells of a velocity beside a speed.
  engine::Vec3 v(Reader&) const;
};
/// Index of the body a key names; -1 for the world (key `parent` only) and, with an error told, for none.
int find_body(Builder&, Reader&, std::string_view key);
/// friction, restitution, each also as _body and _ground, and stiffness on top of `base`.
engine::SurfaceProperties read_surface(Reader&, engine::SurfaceProperties base);
/// Checks that an inertia tensor belongs to some distribution of mass: positive, and no moment above the sum of the others.
void check_inertia(Reader&, std::string_view key, const engine::Mat3& inertia);
/// Tells of a name that is no camera's.
void check_camera_name(Builder&, Reader&, const std::string& name, std::string_view key);

/// Keys that several sections list in their tables.
inline constexpr Key kSurfaceFriction =
    bound_to_both<&engine::SurfaceProperties::friction_body, &engine::SurfaceProperties::friction_ground>(
        {"friction", Type::schedule, Dimension::none, "",
         "Coulomb coefficient, sets both kinds below. Of two objects the smaller acts.", kNotNegative});
inline constexpr Key kSurfaceStiffness =
    bound<&engine::SurfaceProperties::stiffness>({"stiffness", Type::schedule, Dimension::stiffness, "",
                                                  "S of the compliant contact law; two surfaces act in series. Left out: 400 kN/m; "
                                                  "a vehicle's panels then yield to persons each by its own.",
                                                  kPositive});
inline constexpr Key kSurfaceFrictionBody = bound<&engine::SurfaceProperties::friction_body>(
    {"friction_body", Type::schedule, Dimension::none, "", "Coulomb coefficient against every other object.", kNotNegative});
inline constexpr Key kSurfaceFrictionGround = bound<&engine::SurfaceProperties::friction_ground>(
    {"friction_ground", Type::schedule, Dimension::none, "",
     "Coulomb coefficient against the ground; a person's against tyres too.", kNotNegative});
inline constexpr Key kSurfaceRestitution =
    bound_to_both<&engine::SurfaceProperties::restitution_body, &engine::SurfaceProperties::restitution_ground>(
        {"restitution", Type::schedule, Dimension::none, "",
         "Ratio of separating to closing normal speed where contacts are rigid; where they yield (persons, and all with the "
         "compliant law) the share of the energy that comes back. Sets both kinds below. Of two objects the larger acts.",
         kShare});
inline constexpr Key kSurfaceRestitutionBody = bound<&engine::SurfaceProperties::restitution_body>(
    {"restitution_body", Type::schedule, Dimension::none, "", "The same against every other object.", kShare});
inline constexpr Key kSurfaceRestitutionGround = bound<&engine::SurfaceProperties::restitution_ground>(
    {"restitution_ground", Type::schedule, Dimension::none, "", "The same against the ground.", kShare});
#define CRASHREEL_SURFACE_KEYS                                                                                                     \
  kSurfaceFriction, kSurfaceStiffness, kSurfaceFrictionBody, kSurfaceFrictionGround, kSurfaceRestitution, kSurfaceRestitutionBody, \
      kSurfaceRestitutionGround

/// The file that a key names, in the scene's folder or the program's. Only below these, or a folder the user allows, does a scene
/// read: otherwise it would choose what on this machine is opened. Empty after an error, which is collected.
std::filesystem::path asset_file(Builder&, Reader&, std::string_view key, const std::string& kind);

/// Where library, assets and shipped scenes are: CRASHREEL_HOME, else share/crashreel beside the folder of the running program,
/// else where the program was built.
std::filesystem::path home_folder();
/// scene's folder first, then the library: `name`.toml under `kind` ("persons"). None when there is no such file.
std::optional<Value> library_entry(Builder&, const std::string& kind, const std::string& name);
std::vector<std::string> library_names(const Builder&, const std::string& kind);
/// "there is no such pose; did you mean "sitting"? Available: ...": of a `word` that names nothing under `kind`.
std::string not_in_library(const Builder&, const std::string& kind, const std::string& word, const std::string& name);

}  // namespace scenes
