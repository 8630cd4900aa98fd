// The whole program after loading: Model + Stage + Output.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "engine/model/model.h"
#include "render/stage.h"
#include "scenes/error.h"
#include "scenes/inference.h"

namespace scenes {

/// What the scene file says of its pictures; the command line overrides.
struct Output {
  int width = 1280;
  int height = 720;
  double fps = 30;
  std::string quality = "standard";
  struct Still {
    double time = 0;     // [s]
    std::string camera;  // empty: as the film shows it
    int card = -1;       // of the stage's cards, in place of a camera
  };
  std::vector<Still> stills;  // what snapshot tests draw
};

/// A rectangle of pixels that is not compared.
struct SnapshotMask {
  std::string camera;  // empty: every camera
  int left = 0, top = 0, width = 0, height = 0;
};

/// A measure the run must give.
struct Expectation {
  std::string metric;  // as in summary.json, which says the unit
  std::string object;  // empty: the only one that has it
  double value = 0;
  double tolerance = 0;
  std::string written;  // "12.3 m +- 0.1 m"
};

/// How `crashreel snapshot` tests the scene; its pictures are the stills of Output.
struct SnapshotTest {
  int width = 320;
  int height = 180;
  std::map<std::string, double> limits;  // by the name of the measure; those not given have their defaults
  std::vector<SnapshotMask> masks;
  std::vector<Expectation> expectations;
};

/// A scene file as it was when it was read: what is hashed is what was parsed, also of a pipe and of a file saved meanwhile.
struct SceneFile {
  std::filesystem::path path;
  std::string text;
  std::vector<std::filesystem::path> allowed;  // folders, besides its own and the program's, whose meshes and pictures it may name
};
/// Throws SceneErrors where it cannot be read.
SceneFile read_scene_file(const std::filesystem::path&, std::vector<std::filesystem::path> allowed = {});

struct ImportedMesh;
/// Mesh files as they were brought in, and what was made of them for contact: read once for a scene and all its variants. What is
/// written to a mesh file after that is not seen.
struct MeshShelf {
  using Solid = std::shared_ptr<const engine::TriangleMesh>;
  using Look = std::shared_ptr<const render::Mesh>;
  std::map<std::string, std::shared_ptr<const ImportedMesh>> files;                // by path
  std::map<std::pair<Solid, double>, Solid> coarse;                                // by surface and tolerance [m]
  std::map<std::pair<Solid, Look>, std::shared_ptr<const engine::Panels>> panels;  // of a surface, by how its mesh looks
};

struct Scene {
  std::string title;
  SceneFile file;
  std::filesystem::path path;
  std::string sha256;                  // of the file's bytes and the overrides
  std::string assets_sha256;           // of the library files and meshes it read
  std::vector<std::string> overrides;  // "path.to.key=value" as given
  engine::Model model;
  render::Stage stage;
  Output output;
  SnapshotTest snapshot;
  Inference inference;
  std::vector<std::string> warnings;          // file:line:column: what looked odd but loads
  std::vector<std::string> assumed;           // the same of what was taken where the scene left it open
  std::map<std::string, double> closed_form;  // expected measures the scene carries, SI, by metric key
  std::shared_ptr<MeshShelf> meshes;
};

/// Reads, checks and completes a scene. Overrides are applied before checking. Throws SceneErrors with everything found.
Scene load(const SceneFile&, const std::vector<std::string>& overrides = {}, std::shared_ptr<MeshShelf> = nullptr);
Scene load(const std::filesystem::path& file, const std::vector<std::string>& overrides = {});
/// The same scene with overrides on top of its own. Throws SceneErrors.
Scene variant(const Scene&, const std::vector<std::string>& overrides);

/// JSON Schema (draft 2020-12) of the scene format, from the table the loader reads.
std::string json_schema();

}  // namespace scenes
