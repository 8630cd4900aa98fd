// Importing a mesh in a cage. The import library crashes on some valid and many damaged files, and follows references out of the
// folder; so it runs in a forked child that can lose nothing: limited memory, time and files, no writing, an own file system rooted
// at the mesh's folder. The child sends plain arrays through a pipe; the parent believes none of their lengths.
#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <assimp/DefaultIOSystem.h>
#include <assimp/config.h>
#include <assimp/material.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <assimp/Importer.hpp>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <cstring>

#include "scenes/loader/landlock.h"
#include "scenes/loader/mesh.h"
#include "scenes/loader/sha256.h"

#if defined(__SANITIZE_ADDRESS__)
#define CRASHREEL_ADDRESS_LIMIT 0
#else
#define CRASHREEL_ADDRESS_LIMIT 1
#endif

namespace scenes {
namespace {

constexpr rlim_t kMemory = rlim_t{4} << 30;             // [byte] a detailed vehicle needs some hundred MB in the importer
constexpr std::size_t kLargest = std::size_t{1} << 29;  // [byte] of arrays accepted from the child

/// Reads only, and only below one folder: `mtllib ../../etc/passwd` opens nothing.
class CagedFiles : public Assimp::DefaultIOSystem {
 public:
  explicit CagedFiles(const std::filesystem::path& root)
      : root_(std::filesystem::weakly_canonical(std::filesystem::absolute(root.empty() ? "." : root))) {}
  bool Exists(const char* file) const override { return inside(file) && DefaultIOSystem::Exists(file); }
  Assimp::IOStream* Open(const char* file, const char* mode) override {
    return inside(file) && mode && mode[0] == 'r' && !std::strchr(mode, '+') ? DefaultIOSystem::Open(file, mode) : nullptr;
  }

 private:
  bool inside(const char* file) const {
    std::error_code error;
    const auto path = std::filesystem::weakly_canonical(std::filesystem::absolute(file), error);
    return !error && std::mismatch(root_.begin(), root_.end(), path.begin(), path.end()).first == root_.end();
  }
  std::filesystem::path root_;
};

void append(std::string& out, const void* data, std::size_t bytes) {
  out.append(static_cast<const char*>(data), bytes);
}
template <class T>
void append_array(std::string& out, const T* data, std::size_t count) {
  const std::uint64_t n = count;
  append(out, &n, sizeof n);
  append(out, data, count * sizeof(T));
}

void write_material(std::string& out, const aiMaterial& material) {
  aiString name;
  aiColor3D colour(0.6f, 0.6f, 0.6f);
  float opacity = 1;
  material.Get(AI_MATKEY_NAME, name);
  material.Get(AI_MATKEY_COLOR_DIFFUSE, colour);
  material.Get(AI_MATKEY_OPACITY, opacity);
  const float values[4] = {colour.r, colour.g, colour.b, opacity};
  append_array(out, name.C_Str(), std::strlen(name.C_Str()));
  append_array(out, values, 4);
}

void write_mesh(std::string& out, const aiMesh& mesh) {
  static_assert(sizeof(aiVector3D) == 3 * sizeof(float), "vertices travel as plain floats");
  std::vector<std::uint32_t> indices;
  for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
    if (mesh.mFaces[f].mNumIndices == 3) indices.insert(indices.end(), mesh.mFaces[f].mIndices, mesh.mFaces[f].mIndices + 3);
  }
  append_array(out, &mesh.mVertices[0].x, std::size_t{3} * mesh.mNumVertices);
  if (mesh.mNormals) {
    append_array(out, &mesh.mNormals[0].x, std::size_t{3} * mesh.mNumVertices);
  } else {
    append_array(out, &mesh.mVertices[0].x, 0);
  }
  append_array(out, indices.data(), indices.size());
}

std::string import_here(const std::filesystem::path& file, const std::filesystem::path& root) {
  Assimp::Importer importer;
  importer.SetIOHandler(new CagedFiles(root));                             // the importer deletes it
  importer.SetPropertyFloat(AI_CONFIG_PP_GSN_MAX_SMOOTHING_ANGLE, 50.0f);  // sharper edges than this stay edges
  importer.SetPropertyInteger(AI_CONFIG_PP_SBP_REMOVE, aiPrimitiveType_POINT | aiPrimitiveType_LINE);
  const aiScene* scene =
      importer.ReadFile(file.string(), aiProcess_Triangulate | aiProcess_JoinIdenticalVertices | aiProcess_SortByPType |
                                           aiProcess_GenSmoothNormals | aiProcess_PreTransformVertices);
  if (!scene) return "E" + std::string(importer.GetErrorString());
  if (scene->mNumMeshes == 0) return "Ethe file has no triangles";
  std::string out = "M";
  for (unsigned i = 0; i < scene->mNumMeshes; ++i) {
    write_material(out, *scene->mMaterials[scene->mMeshes[i]->mMaterialIndex]);
    write_mesh(out, *scene->mMeshes[i]);
  }
  return out;
}

void limit(int resource, rlim_t value) {
  const rlimit both{value, value};
  setrlimit(static_cast<__rlimit_resource>(resource), &both);
}

[[noreturn]] void child(int out, const std::filesystem::path& file, const std::filesystem::path& root, const CageLimits& limits) {
  if (const int null = open("/dev/null", O_RDWR); null >= 0) {
    dup2(null, 0);
    dup2(null, 1);
    dup2(null, 2);
  }
  prctl(PR_SET_PDEATHSIG, SIGKILL);  // nobody reads on from a parent that was killed
  limit(RLIMIT_CORE, 0);
  limit(RLIMIT_FSIZE, 0);
  limit(RLIMIT_CPU, static_cast<rlim_t>(limits.cpu_time));
  limit(RLIMIT_NOFILE, 64);
  if (CRASHREEL_ADDRESS_LIMIT) limit(RLIMIT_AS, kMemory);
  confine_to(root);  // where the kernel cannot, the rooted file system below is the wall
  std::string bytes;
  try {
    bytes = import_here(file, root);
  } catch (const std::exception& error) {
    bytes = std::string("E") + error.what();
  }
  for (std::size_t sent = 0; sent < bytes.size();) {
    const ssize_t n = write(out, bytes.data() + sent, bytes.size() - sent);
    if (n < 0 && errno != EINTR) _exit(1);
    if (n > 0) sent += static_cast<std::size_t>(n);
  }
  _exit(0);
}

/// Takes arrays off a message; after the first that does not fit, everything is empty.
class Message {
 public:
  explicit Message(std::string_view bytes) : bytes_(bytes) {}
  bool more() const { return good_ && !bytes_.empty(); }
  bool good() const { return good_; }
  template <class T, class Container>
  void take(Container& out) {
    std::uint64_t n = 0;
    if (bytes_.size() < sizeof n) {
      good_ = false;
      return;
    }
    std::memcpy(&n, bytes_.data(), sizeof n);
    bytes_.remove_prefix(sizeof n);
    if (n > bytes_.size() / sizeof(T)) {
      good_ = false;
      return;
    }
    out.resize(n);
    std::memcpy(out.data(), bytes_.data(), n * sizeof(T));
    bytes_.remove_prefix(n * sizeof(T));
  }

 private:
  std::string_view bytes_;
  bool good_ = true;
};

CageResult unpacked(const std::string& bytes) {
  CageResult out;
  if (bytes.empty()) return {{}, "the import crashed or ran out of its limits; convert the file to OBJ and try again", {}};
  if (bytes[0] != 'M') return {{}, bytes.substr(1, 300), {}};
  Message message(std::string_view(bytes).substr(1));
  while (message.more()) {
    RawPart part;
    std::vector<float> values;
    message.take<char>(part.material);
    message.take<float>(values);
    message.take<float>(part.positions);
    message.take<float>(part.normals);
    message.take<std::uint32_t>(part.indices);
    const std::size_t vertices = part.positions.size() / 3;
    const bool fits = message.good() && values.size() == 4 && part.positions.size() % 3 == 0 && part.indices.size() % 3 == 0 &&
                      (part.normals.empty() || part.normals.size() == part.positions.size()) &&
                      std::all_of(part.indices.begin(), part.indices.end(), [&](std::uint32_t i) { return i < vertices; });
    if (!fits) return {{}, "the import broke off; convert the file to OBJ and try again", {}};
    // damaged files have colours that are none
    for (float& value : values) value = std::isfinite(value) ? std::clamp(value, 0.0f, 1.0f) : 0.6f;
    std::copy_n(values.begin(), 3, part.colour);
    part.opacity = values[3];
    out.parts.push_back(std::move(part));
  }
  out.sha256 = sha256(bytes);
  return out;
}

/// Everything the child sends, or nothing when it dawdles, sends too much or dies.
std::string received(int in, pid_t worker, int patience) {
  std::string bytes;
  bool whole = false;
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(patience);
  std::vector<char> buffer(1 << 16);
  for (;;) {
    const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(deadline - std::chrono::steady_clock::now()).count();
    pollfd ready{in, POLLIN, 0};
    if (left <= 0 || bytes.size() > kLargest) break;
    const int events = poll(&ready, 1, static_cast<int>(left));
    if (events < 0 && errno == EINTR) continue;
    if (events <= 0) break;
    const ssize_t n = read(in, buffer.data(), buffer.size());
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) {
      whole = n == 0;
      break;
    }
    bytes.append(buffer.data(), static_cast<std::size_t>(n));
  }
  if (!whole) kill(worker, SIGKILL);
  int status = 0;
  while (waitpid(worker, &status, 0) < 0 && errno == EINTR) {
  }
  return whole && WIFEXITED(status) && WEXITSTATUS(status) == 0 ? bytes : std::string();
}

}  // namespace

CageResult import_in_cage(const std::filesystem::path& file, const std::filesystem::path& root, const CageLimits& limits) {
  int ends[2];
  if (pipe2(ends, O_CLOEXEC) != 0) return {{}, std::string("no pipe to the import: ") + std::strerror(errno), {}};
  const pid_t worker = fork();
  if (worker == 0) child(ends[1], file, root, limits);
  close(ends[1]);
  CageResult out = worker < 0 ? CageResult{{}, std::string("no process for the import: ") + std::strerror(errno), {}}
                              : unpacked(received(ends[0], worker, limits.patience));
  close(ends[0]);
  return out;
}

}  // namespace scenes
