// Damaged meshes by the thousand through the loader and its cage: mutated_meshes --meshes N [--seed N] [--folder DIR]
// A small mesh is written in every format of the white list and its variants, then damaged: bytes, numbers, lengths, pieces of
// other files, and references that point out of the folder. Whatever comes of it must be a mesh of finite numbers or a message that
// names the file. tests/campaigns runs this under strace and looks at what was opened.
#include <stdlib.h>

#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <assimp/Exporter.hpp>
#include <assimp/Importer.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <random>
#include <string>
#include <vector>

#include "scenes/scene.h"

namespace fs = std::filesystem;

namespace {

struct Seed {
  std::string ending, bytes;
};

std::string contents(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

void write(const fs::path& file, const std::string& bytes) {
  std::ofstream(file, std::ios::binary) << bytes;
}

const char* const kTetrahedronOff = "OFF\n4 4 6\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n";
const char* const kTetrahedronAc =
    "AC3Db\nMATERIAL \"paint\" rgb 0.5 0.1 0.1 amb 0.2 0.2 0.2 emis 0 0 0 spec 0.5 0.5 0.5 shi 10 trans 0\nOBJECT world\nkids 1\n"
    "OBJECT poly\nname \"t\"\ntexture \"paint.png\"\nnumvert 4\n0 0 0\n1 0 0\n0 1 0\n0 0 1\nnumsurf 4\n"
    "SURF 0x20\nmat 0\nrefs 3\n0 0 0\n2 0 1\n1 1 0\nSURF 0x20\nmat 0\nrefs 3\n0 0 0\n1 0 1\n3 1 0\n"
    "SURF 0x20\nmat 0\nrefs 3\n0 0 0\n3 0 1\n2 1 0\nSURF 0x20\nmat 0\nrefs 3\n1 0 0\n2 0 1\n3 1 0\nkids 0\n";

/// A box with a material, written by the import library's own exporters; two formats it cannot write, by hand.
std::vector<Seed> seeds(const fs::path& folder) {
  fs::create_directories(folder);
  write(folder / "paint.mtl", "newmtl paint\nKd 0.5 0.1 0.1\nmap_Kd paint.png\n");
  std::string box = "mtllib paint.mtl\nusemtl paint\n";
  for (int i = 0; i < 8; ++i)
    box += "v " + std::to_string(i & 1 ? 2 : -2) + (i & 2 ? " 0.9" : " -0.9") + (i & 4 ? " 1.4\n" : " 0\n");
  box += "vt 0 0\nvt 1 0\nvt 1 1\n";
  for (const char* face : {"1 3 4 2", "5 6 8 7", "1 2 6 5", "3 7 8 4", "1 5 7 3", "2 4 8 6"})
    box += std::string("f ") + face + "\n";
  write(folder / "box.obj", box);
  std::vector<Seed> out{{".obj", box}, {".off", kTetrahedronOff}, {".ac", kTetrahedronAc}};
  Assimp::Importer importer;
  const aiScene* scene = importer.ReadFile((folder / "box.obj").string(), aiProcess_Triangulate | aiProcess_GenNormals);
  if (!scene) throw std::runtime_error(importer.GetErrorString());
  Assimp::Exporter exporter;
  constexpr const char* kFormats[][2] = {{"obj", ".obj"},  {"stl", ".stl"},     {"stlb", ".stl"}, {"ply", ".ply"},
                                         {"plyb", ".ply"}, {"gltf2", ".gltf"},  {"glb2", ".glb"}, {"gltf", ".gltf"},
                                         {"glb", ".glb"},  {"collada", ".dae"}, {"3ds", ".3ds"},  {"x", ".x"},
                                         {"fbx", ".fbx"},  {"fbxa", ".fbx"}};
  for (const auto& [format, ending] : kFormats) {
    const fs::path file = folder / (std::string("seed_") + format + ending);
    if (exporter.Export(scene, format, file.string()) == aiReturn_SUCCESS) out.push_back({ending, contents(file)});
  }
  return out;
}

class Damage {
 public:
  Damage(unsigned long seed, const std::vector<Seed>& all) : chance_(seed), all_(all) {}

  Seed make() {
    Seed out = all_[below(all_.size())];
    // most of them a little, so that they come through; some a lot
    for (std::size_t i = 0, n = 1 + below(below(4) == 0 ? 12 : 2); i < n && !out.bytes.empty(); ++i) once(out.bytes);
    return out;
  }

 private:
  std::size_t below(std::size_t n) { return static_cast<std::size_t>(chance_() % n); }

  void once(std::string& bytes) {
    const std::size_t at = below(bytes.size());
    switch (below(8)) {
      case 0:
        bytes[at] = static_cast<char>(below(256));
        break;
      case 1:
        bytes[at] = static_cast<char>(bytes[at] ^ (1 << below(8)));
        break;
      case 2:  // a length or an index of four bytes
        for (std::size_t k = 0, odd = below(4); k < 4 && at + k < bytes.size(); ++k)
          bytes[at + k] = odd == 0   ? '\xff'
                          : odd == 1 ? '\0'
                          : odd == 2 ? (k == 3 ? '\x7f' : '\xff')
                                     : static_cast<char>(below(256));
        break;
      case 3:
        number(bytes, at);
        break;
      case 4:
        reference(bytes, at);
        break;
      case 5:
        bytes.erase(at, 1 + below(below(4) == 0 ? bytes.size() : 16));
        break;
      case 6:
        bytes.insert(at, bytes.substr(below(bytes.size()), 1 + below(64)));
        break;
      default: {
        const std::string& other = all_[below(all_.size())].bytes;
        bytes.insert(at, other.substr(below(other.size()), 1 + below(200)));
      }
    }
  }

  /// The next number of a text becomes one that hurts.
  void number(std::string& bytes, std::size_t at) {
    const char* kDigits = "0123456789.-+eE";
    const std::size_t begin = bytes.find_first_of("0123456789", at);
    if (begin == std::string::npos) return;
    const std::size_t end = std::min(bytes.find_first_not_of(kDigits, begin), bytes.size());
    const char* hurting[] = {"nan",   "1e999", "-1", "4294967295", "2147483647", "1e38", "-inf", "0", "99999999999999999999",
                             "1e-46", ""};
    bytes.replace(begin, end - begin, hurting[below(std::size(hurting))]);
  }

  /// A word becomes the name of a file that must not be opened; where files name others, a fair share of these are references.
  void reference(std::string& bytes, std::size_t at) {
    const char* kWords[] = {"paint.mtl", "paint.png", ".bin", ".mtl", "uri\":\"", "mtllib ", "TextureFilename", "<init_from>"};
    const char* word = kWords[below(std::size(kWords))];
    std::size_t begin = bytes.find(word);
    if (begin == std::string::npos) begin = at;
    const char* targets[] = {"../outside/secret.mtl",        "/etc/passwd",
                             "../../../../../../etc/passwd", "file:///etc/hostname",
                             "..\\outside\\secret.mtl",      "./../outside/secret.bin",
                             "/proc/self/environ",           "link/secret.mtl"};
    const std::string target = targets[below(std::size(targets))];
    bytes.replace(begin, std::min<std::size_t>(below(16), bytes.size() - begin), below(2) ? "mtllib " + target + "\n" : target);
  }

  std::mt19937_64 chance_;
  const std::vector<Seed>& all_;
};

// what a scene must hold besides its ground
constexpr const char* kBall = "[[body]]\nname = \"ball\"\nmass = \"1 kg\"\naxes = \"0.1 0.1 0.1 m\"\nposition = \"0 0 50 m\"\n";

bool finite(const scenes::Scene& scene) {
  const auto& solid = *scene.model.ground.terrain;
  for (const engine::Vec3& v : solid.vertices())
    if (!v.allFinite()) return false;
  for (const float x : scene.stage.road.terrain->positions)
    if (!std::isfinite(x)) return false;
  for (const float x : scene.stage.road.terrain->normals)
    if (!std::isfinite(x)) return false;
  return true;
}

}  // namespace

int main(int argc, char** argv) {
  unsigned long meshes = 1000, seed = 1;
  std::string pattern = (fs::temp_directory_path() / "crashreel_meshes_XXXXXX").string();
  fs::path root;
  for (int i = 1; i + 1 < argc; i += 2) {
    const std::string name = argv[i];
    if (name == "--meshes") meshes = std::strtoul(argv[i + 1], nullptr, 10);
    if (name == "--seed") seed = std::strtoul(argv[i + 1], nullptr, 10);
    if (name == "--folder") root = argv[i + 1];
  }
  if (root.empty()) root = mkdtemp(pattern.data());
  const std::vector<Seed> all = seeds(root / "inside");
  fs::create_directories(root / "outside");
  for (const char* name : {"secret.mtl", "secret.bin"}) write(root / "outside" / name, "newmtl paint\nKd 1 0 0\n");
  std::error_code there;
  fs::create_directory_symlink("../outside", root / "inside/link", there);

  std::map<std::string, std::pair<long, long>> kinds;  // imported, refused
  int broken = 0;
  const auto complain = [&](unsigned long i, const Seed& mesh, const char* what) {
    ++broken;
    const fs::path kept = root / ("broken_" + std::to_string(seed + i) + mesh.ending);
    write(kept, mesh.bytes);
    std::printf("mesh %lu: %s, see %s\n", seed + i, what, kept.c_str());
    std::fflush(stdout);
  };
  for (unsigned long i = 0; i < meshes; ++i) {
    // the first ones as they are
    const Seed mesh = i < all.size() ? all[i] : Damage(seed + i, all).make();
    const std::string name = "mesh" + mesh.ending;
    write(root / "inside" / name, mesh.bytes);
    write(root / "inside/case.toml", "[ground]\nterrain = \"" + name + "\"\n" + kBall);
    try {
      if (!finite(scenes::load(root / "inside/case.toml"))) complain(i, mesh, "not finite");
      ++kinds[mesh.ending].first;
    } catch (const scenes::SceneErrors& errors) {
      const bool told = std::all_of(errors.lines.begin(), errors.lines.end(),
                                    [&](const std::string& line) { return line.find(name) != std::string::npos; });
      if (errors.lines.empty() || !told) complain(i, mesh, "refused without its name");
      ++kinds[mesh.ending].second;
    }
  }
  std::printf("%lu damaged meshes from %zu seeds, %d promises broken; imported, refused:", meshes, all.size(), broken);
  for (const auto& [ending, counts] : kinds) std::printf(" %s %ld %ld", ending.c_str(), counts.first, counts.second);
  std::printf("\n");
  if (broken == 0 && pattern.find("XXXXXX") == std::string::npos) fs::remove_all(root);
  return broken == 0 ? 0 : 1;
}
