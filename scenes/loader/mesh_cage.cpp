// What the caged importer says of a mesh: taken apart with every count held against what is there.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <stdexcept>

#include "scenes/loader/cage.h"
#include "scenes/loader/mesh.h"
#include "scenes/loader/sha256.h"

namespace scenes {
namespace {

constexpr std::size_t kMostTriangles = 5'000'000;  // a detailed vehicle has one million; more would cost seconds for each

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
    if (n > 0) std::memcpy(out.data(), bytes_.data(), n * sizeof(T));
    bytes_.remove_prefix(n * sizeof(T));
  }

 private:
  std::string_view bytes_;
  bool good_ = true;
};

std::string contents(const std::filesystem::path& file) {
  std::error_code none;
  const std::uintmax_t size = std::filesystem::file_size(file, none);
  std::string out(none ? 0 : size, '\0');
  std::ifstream(file, std::ios::binary).read(out.data(), static_cast<std::streamsize>(out.size()));
  return out;
}

/// Of the mesh and of the materials beside it.
std::string hashes_of(const std::filesystem::path& file) {
  return sha256(contents(file)) + sha256(contents(std::filesystem::path(file).replace_extension(".mtl")));
}

}  // namespace

std::string kept_import(const std::filesystem::path& file) {
  const CageAnswer answer = ask_cage(file, file.parent_path());
  if (!answer.problem.empty()) throw std::runtime_error(file.string() + " " + answer.problem);
  return hashes_of(file) + sha256(answer.bytes) + answer.bytes;
}

std::optional<CageResult> imported_before(const std::filesystem::path& file, const std::filesystem::path& library) {
  std::error_code none;
  if (!std::filesystem::equivalent(file.parent_path(), library, none) || none) return std::nullopt;
  const std::string kept = contents(file.string() + ".imported");
  if (kept.empty()) return std::nullopt;
  const std::string hashes = hashes_of(file);
  constexpr std::size_t kHash = 64;
  if (!kept.starts_with(hashes) || kept.size() < hashes.size() + kHash) return std::nullopt;
  const auto [hash, answer] =
      std::pair(std::string_view(kept).substr(hashes.size(), kHash), std::string_view(kept).substr(hashes.size() + kHash));
  CageResult out = unpacked(answer);
  if (!out.problem.empty() || out.sha256 != hash) return std::nullopt;
  return out;
}

CageResult unpacked(std::string_view bytes) {
  CageResult out;
  std::size_t triangles = 0;
  Message message(bytes.substr(std::min<std::size_t>(1, bytes.size())));
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
    if (!fits) return {{}, "the import broke off; convert the file to OBJ and try again", {}, {}};
    // damaged files have colours that are none
    for (float& value : values) value = std::isfinite(value) ? std::clamp(value, 0.0f, 1.0f) : 0.6f;
    std::copy_n(values.begin(), 3, part.colour);
    part.opacity = values[3];
    triangles += part.indices.size() / 3;
    if (triangles > kMostTriangles)
      return {{}, fmt::format("it has more than {} million triangles; thin it out", kMostTriangles / 1'000'000), {}, {}};
    out.parts.push_back(std::move(part));
  }
  out.sha256 = sha256(bytes);
  return out;
}

CageResult import_in_cage(const std::filesystem::path& file, const std::filesystem::path& root, const CageLimits& limits) {
  const CageAnswer answer = ask_cage(file, root, limits);
  if (!answer.problem.empty()) return {{}, answer.problem, {}, answer.warning};
  CageResult out = unpacked(answer.bytes);
  out.warning = answer.warning;
  return out;
}

}  // namespace scenes
