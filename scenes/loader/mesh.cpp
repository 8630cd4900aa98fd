// From the cage's arrays to the engine's mesh and the renderer's, with an audit of what looks wrong.
#include "scenes/loader/mesh.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <unordered_map>
#include <unordered_set>

#include "engine/math/functions.h"

namespace scenes {
namespace {

std::string lower_case(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

struct MaterialLine {
  std::string_view word;  // in the material's name
  render::MaterialKind kind;
  float roughness;
};

/// What a surface is, by its name: meshes carry colours, rarely how they shine.
constexpr MaterialLine kMaterials[] = {
    {"under", render::MaterialKind::matte, 0.9f},  // the underbody is no paint
    {"glass", render::MaterialKind::glass, 0.05f},  {"window", render::MaterialKind::glass, 0.05f},
    {"lamp", render::MaterialKind::lamp, 0.15f},    {"light", render::MaterialKind::lamp, 0.15f},
    {"tyre", render::MaterialKind::rubber, 0.9f},   {"tire", render::MaterialKind::rubber, 0.9f},
    {"rubber", render::MaterialKind::rubber, 0.9f}, {"trim", render::MaterialKind::rubber, 0.7f},
    {"chrome", render::MaterialKind::metal, 0.15f}, {"rim", render::MaterialKind::metal, 0.35f},
    {"metal", render::MaterialKind::metal, 0.35f},  {"paint", render::MaterialKind::paint, 0.25f},
    {"body", render::MaterialKind::paint, 0.25f}};

render::Material material_of(const RawPart& part) {
  // colours in mesh files are meant for the screen (sRGB); the stage wants light
  const auto linear = [](float c) {
    return static_cast<float>(c <= 0.04045 ? c / 12.92 : engine::math::pow((c + 0.055) / 1.055, 2.4));
  };
  render::Material out{part.material,
                       render::MaterialKind::matte,
                       {linear(part.colour[0]), linear(part.colour[1]), linear(part.colour[2])},
                       0.7f,
                       std::clamp(part.opacity, 0.05f, 1.0f)};
  const std::string name = lower_case(part.material);
  for (const MaterialLine& line : kMaterials) {
    if (name.find(line.word) == std::string::npos) continue;
    out.kind = line.kind;
    out.roughness = line.roughness;
    break;
  }
  return out;
}

std::shared_ptr<const render::Mesh> look_of(const std::vector<RawPart>& parts) {
  auto out = std::make_shared<render::Mesh>();
  for (const RawPart& part : parts) {
    const auto base = static_cast<std::uint32_t>(out->positions.size() / 3);
    out->parts.push_back({static_cast<std::uint32_t>(out->indices.size()), static_cast<std::uint32_t>(part.indices.size()),
                          static_cast<int>(out->materials.size())});
    out->materials.push_back(material_of(part));
    out->positions.insert(out->positions.end(), part.positions.begin(), part.positions.end());
    out->normals.insert(out->normals.end(), part.normals.begin(), part.normals.end());
    out->normals.resize(out->positions.size(), 0.0f);
    for (std::uint32_t i : part.indices) out->indices.push_back(base + i);
  }
  return out;
}

std::shared_ptr<const Solid> solid_of(const std::vector<RawPart>& parts) {
  std::vector<engine::Vec3> vertices;
  std::vector<engine::Triangle> triangles;
  for (const RawPart& part : parts) {
    const auto base = static_cast<std::int32_t>(vertices.size());
    for (std::size_t i = 0; i < part.positions.size(); i += 3)
      vertices.emplace_back(part.positions[i], part.positions[i + 1], part.positions[i + 2]);
    for (std::size_t i = 0; i < part.indices.size(); i += 3) {
      triangles.push_back({base + static_cast<std::int32_t>(part.indices[i]), base + static_cast<std::int32_t>(part.indices[i + 1]),
                           base + static_cast<std::int32_t>(part.indices[i + 2])});
    }
  }
  return std::make_shared<Solid>(engine::WeldedTriangles(std::move(vertices), triangles));
}

/// glTF says y up, z forward (its specification, 3.4); the collada reader turns everything to that as well. We are x forward, z up.
void turn_upright(std::vector<RawPart>& parts, const std::string& extension) {
  if (extension != ".gltf" && extension != ".glb" && extension != ".dae") return;
  for (RawPart& part : parts) {
    for (auto* array : {&part.positions, &part.normals}) {
      for (std::size_t i = 0; i + 2 < array->size(); i += 3)
        std::rotate(array->begin() + static_cast<long>(i), array->begin() + static_cast<long>(i) + 2,
                    array->begin() + static_cast<long>(i) + 3);
    }
  }
}

constexpr float kFarthest = 1e6f;  // [m] no accident is larger; volumes of much larger numbers overflow

bool is_sound(float x) {
  return std::abs(x) <= kFarthest;
}

/// Triangles with a corner that is not finite cannot be drawn or touched.
int drop_not_finite(std::vector<RawPart>& parts) {
  int dropped = 0;
  for (RawPart& part : parts) {
    std::vector<std::uint32_t> kept;
    for (std::size_t i = 0; i < part.indices.size(); i += 3) {
      bool finite = true;
      for (std::size_t k = 0; k < 9; ++k) finite = finite && is_sound(part.positions[3 * part.indices[i + k / 3] + k % 3]);
      if (finite) {
        kept.insert(kept.end(), part.indices.begin() + static_cast<long>(i), part.indices.begin() + static_cast<long>(i) + 3);
      } else {
        ++dropped;
      }
    }
    part.indices = std::move(kept);
    for (float& x : part.positions)
      if (!is_sound(x)) x = 0;
    // a normal made of a triangle without area
    for (std::size_t i = 0; i + 2 < part.normals.size(); i += 3) {
      float* normal = &part.normals[i];
      if (!is_sound(normal[0]) || !is_sound(normal[1]) || !is_sound(normal[2]))
        std::copy_n(std::array{0.0f, 0.0f, 1.0f}.data(), 3, normal);
    }
  }
  return dropped;
}

struct WordsHash {
  std::size_t operator()(const std::array<std::uint32_t, 3>& words) const {
    std::uint64_t out = 0;
    for (const std::uint32_t word : words) {
      out = (out ^ word) * 0x9e3779b97f4a7c15u;
      out ^= out >> 32;
    }
    return out;
  }
};

/// Equal places get equal numbers, in whichever part and however often they stand there.
class PlaceNumbers {
 public:
  explicit PlaceNumbers(std::size_t most) { numbers_.reserve(most); }
  std::vector<std::uint32_t> of(const std::vector<float>& positions) {
    std::vector<std::uint32_t> out;
    out.reserve(positions.size() / 3);
    for (std::size_t i = 0; i + 2 < positions.size(); i += 3) {
      std::array<std::uint32_t, 3> bits{};
      // zero has two signs, and is one place
      for (std::size_t k = 0; k < 3; ++k) bits[k] = std::bit_cast<std::uint32_t>(positions[i + k] + 0.0f);
      out.push_back(numbers_.try_emplace(bits, static_cast<std::uint32_t>(numbers_.size())).first->second);
    }
    return out;
  }

 private:
  std::unordered_map<std::array<std::uint32_t, 3>, std::uint32_t, WordsHash> numbers_;
};

}  // namespace

std::vector<std::string> audit(const std::vector<RawPart>& parts, const std::string& file) {
  int degenerate = 0;
  int duplicates = 0;
  double volume = 0, area = 0;
  engine::Vec3 facing = engine::Vec3::Zero();  // sum of area vectors: nothing for a closed surface
  engine::Aabb box;
  std::size_t corners = 0, triangles = 0;
  for (const RawPart& part : parts) {
    corners += part.positions.size() / 3;
    triangles += part.indices.size() / 3;
  }
  PlaceNumbers places(corners);
  std::unordered_set<std::array<std::uint32_t, 3>, WordsHash> seen;
  seen.reserve(triangles);
  for (const RawPart& part : parts) {
    const std::vector<std::uint32_t> number = places.of(part.positions);
    const auto corner = [&](std::uint32_t i) {
      return std::array<float, 3>{part.positions[3 * i], part.positions[3 * i + 1], part.positions[3 * i + 2]};
    };
    for (std::size_t i = 0; i < part.indices.size(); i += 3) {
      const std::array<std::array<float, 3>, 3> t{corner(part.indices[i]), corner(part.indices[i + 1]),
                                                  corner(part.indices[i + 2])};
      const auto vec = [](const std::array<float, 3>& a) { return engine::Vec3(a[0], a[1], a[2]); };
      const engine::Vec3 a = vec(t[0]), b = vec(t[1]), c = vec(t[2]);
      const double edge2 = std::max({(b - a).squaredNorm(), (c - b).squaredNorm(), (a - c).squaredNorm()});
      if ((b - a).cross(c - a).norm() < 1e-12 * edge2 || edge2 == 0) ++degenerate;
      volume += a.dot(b.cross(c)) / 6;
      facing += (b - a).cross(c - a);
      area += (b - a).cross(c - a).norm();
      for (const engine::Vec3& p : {a, b, c}) {
        box.lower = box.lower.cwiseMin(p);
        box.upper = box.upper.cwiseMax(p);
      }
      std::array<std::uint32_t, 3> key{number[part.indices[i]], number[part.indices[i + 1]], number[part.indices[i + 2]]};
      std::sort(key.begin(), key.end());
      if (!seen.insert(key).second) ++duplicates;
    }
  }
  std::vector<std::string> out;
  if (degenerate > 0) out.push_back(fmt::format("{} has {} degenerate triangles; they are left out of contact", file, degenerate));
  if (duplicates > 0) out.push_back(fmt::format("{} has {} duplicate triangles; they are left out of contact", file, duplicates));
  // a clearly negative volume of a closed surface means faces turned inwards; sheets and terrain have none to speak of
  if (box.upper.x() >= box.lower.x() && facing.norm() < 0.05 * area && volume < -0.05 * (box.upper - box.lower).prod())
    out.push_back(fmt::format("{} is inside out: its triangles run clockwise seen from outside", file));
  return out;
}

int open_edges(const engine::TriangleMesh& mesh) {
  int open = 0;
  for (int t = 0; t < static_cast<int>(mesh.triangles().size()); ++t)
    for (int edge = 0; edge < 3; ++edge) open += mesh.neighbour(t, edge) < 0;
  return open;
}

namespace {

/// Null, with a problem told, where the file cannot be imported.
std::shared_ptr<const ImportedMesh> bring_in(const std::filesystem::path& file, const std::string& extension,
                                             std::string& problem) {
  auto kept = imported_before(file, home_folder() / "assets/vehicles");
  CageResult result = kept ? std::move(*kept) : import_in_cage(file, file.parent_path());
  problem = result.problem;
  if (!problem.empty()) return nullptr;
  turn_upright(result.parts, extension);
  auto out = std::make_shared<ImportedMesh>();
  out->not_finite = drop_not_finite(result.parts);
  out->warnings = audit(result.parts, file.filename().string());
  if (!result.warning.empty())
    out->warnings.push_back(
        fmt::format("this system has no {}: a wall is missing around what reads foreign meshes", result.warning));
  out->look = look_of(result.parts);
  out->solid = solid_of(result.parts);
  out->sha256 = result.sha256;
  return out;
}

/// The importer's complaint in words of the file.
std::string import_problem(const std::string& theirs, const std::string& extension) {
  const auto says = [&theirs](const char* words) { return theirs.find(words) != std::string::npos; };
  if (says("No output meshes") || says("orphaned") || says("no triangles"))
    return "holds points or lines but no triangles; a scan must be meshed first";
  if (says("too small") || says("no suitable reader") || says("Unable to open"))
    return fmt::format("is no {} file; its name and its content disagree", extension);
  return fmt::format("is damaged or no {0} file; export it again ({1})", extension, theirs);
}

}  // namespace

std::shared_ptr<const ImportedMesh> import_mesh(Builder& builder, Reader& r, std::string_view key) {
  const std::string name = r.text(key);
  if (name.empty()) return nullptr;
  const auto extension = lower_case(std::filesystem::path(name).extension().string());
  if (std::find(kMeshFormats.begin(), kMeshFormats.end(), extension) == kMeshFormats.end()) {
    r.fail(key, fmt::format("must be a mesh file of a known kind: {}", fmt::join(kMeshFormats, " ")));
    return nullptr;
  }
  const std::filesystem::path file = asset_file(builder, r, key, "a mesh file");
  if (file.empty()) return nullptr;
  auto& cached = builder.meshes[file.string()];
  if (cached) return cached;
  auto& imported = builder.scene.meshes->files[file.string()];
  std::string problem;
  if (!imported) imported = bring_in(std::filesystem::canonical(file), extension, problem);
  if (!imported) {
    r.fail(key, import_problem(problem, extension));
    return nullptr;
  }
  builder.assets += imported->sha256;
  if (imported->not_finite > 0)
    r.warn(key, fmt::format("has {} triangles with coordinates that are not finite or farther than 1000 km; they are left out",
                            imported->not_finite));
  for (const std::string& warning : imported->warnings) r.errors().warn(r.place(key), warning);
  if (imported->solid->empty()) {
    r.fail(key, "has no triangle with an area; there is nothing to touch");
    return nullptr;
  }
  cached = imported;
  return cached;
}

}  // namespace scenes
