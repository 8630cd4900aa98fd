// Mesh files: brought in by assimp inside a cage, audited, and turned into what the engine touches and the renderer draws.
#pragma once

#include <array>
#include <filesystem>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "engine/geometry/triangle_mesh.h"
#include "render/stage.h"
#include "scenes/loader/builder.h"
#include "scenes/loader/cage.h"

namespace scenes {

constexpr std::array<std::string_view, 11> kMeshFormats{".obj", ".stl", ".gltf", ".glb", ".dae", ".3ds",
                                                        ".ac",  ".fbx", ".off",  ".ply", ".x"};

/// One mesh of a file with one material, as the cage hands it back.
struct RawPart {
  std::string material;
  float colour[3] = {0.6f, 0.6f, 0.6f};  // linear
  float opacity = 1;
  std::vector<float> positions;  // xyz
  std::vector<float> normals;    // xyz, as many as positions
  std::vector<std::uint32_t> indices;
};

struct CageResult {
  std::vector<RawPart> parts;
  std::string problem;  // empty: imported
  std::string sha256;   // of everything that came out of it, the files it refers to included
  std::string warning;  // walls of the cage that this system could not raise
};

/// Imports a mesh in the cage; of other files it gets those below `root`. Never throws.
CageResult import_in_cage(const std::filesystem::path& file, const std::filesystem::path& root, const CageLimits& = {});
/// What the build had the cage say of a mesh of the library (assets/import.cpp), where the mesh and its materials are still the
/// same; nothing of a file that does not lie in `library`.
std::optional<CageResult> imported_before(const std::filesystem::path& file, const std::filesystem::path& library);
/// What is kept for that, as the bytes of the file NAME.obj.imported. Throws std::runtime_error where the mesh cannot be read.
std::string kept_import(const std::filesystem::path& file);
/// What the caged importer's answer holds: any bytes, for it may have been taken over.
CageResult unpacked(std::string_view answer);

/// The triangles that can be touched. Their edges and tree are built when first asked for: of what is only drawn, never.
class Solid {
 public:
  explicit Solid(engine::WeldedTriangles welded)
      : welded_(std::move(welded)), bounds_(welded_.bounds), empty_(welded_.triangles.empty()) {}
  const engine::Aabb& bounds() const { return bounds_; }
  bool empty() const { return empty_; }
  const std::shared_ptr<const engine::TriangleMesh>& mesh() const {
    std::call_once(built_, [this] { mesh_ = std::make_shared<engine::TriangleMesh>(std::move(welded_)); });
    return mesh_;
  }

 private:
  mutable engine::WeldedTriangles welded_;  // until the mesh is built
  mutable std::shared_ptr<const engine::TriangleMesh> mesh_;
  mutable std::once_flag built_;
  engine::Aabb bounds_;
  bool empty_;
};

struct ImportedMesh {
  std::shared_ptr<const Solid> solid;
  std::shared_ptr<const render::Mesh> look;  // with normals and materials
  std::vector<std::string> warnings;         // what the audit found odd
  int not_finite = 0;                        // triangles left out
  std::string sha256;                        // of the file and those it refers to
};

/// The mesh file named by the reader's key, found in the scene's folder or the assets, loaded once per load. Null after an error,
/// which is collected.
std::shared_ptr<const ImportedMesh> import_mesh(Builder&, Reader&, std::string_view key);

/// Edges of triangles that no other triangle shares: a closed surface has none.
int open_edges(const engine::TriangleMesh&);

/// What is odd about a mesh (without changing it): not finite, degenerate, duplicate, inside out.
std::vector<std::string> audit(const std::vector<RawPart>&, const std::string& file);

}  // namespace scenes
