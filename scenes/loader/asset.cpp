// Files that a scene names besides itself: where they may lie.
#include <fmt/format.h>

#include <algorithm>

#include "scenes/loader/builder.h"

namespace scenes {
namespace {

namespace fs = std::filesystem;

/// Links followed on both sides: what counts is where the bytes are.
bool lies_below(const fs::path& file, const fs::path& folder) {
  std::error_code gone;
  const fs::path inner = fs::canonical(file, gone), outer = fs::canonical(folder.empty() ? "." : folder, gone);
  if (gone) return false;
  return std::mismatch(outer.begin(), outer.end(), inner.begin(), inner.end()).first == outer.end();
}

bool may_read(const Builder& builder, const fs::path& file) {
  if (lies_below(file, builder.folder) || lies_below(file, home_folder())) return true;
  const auto& allowed = builder.scene.file.allowed;
  return std::any_of(allowed.begin(), allowed.end(), [&file](const fs::path& folder) { return lies_below(file, folder); });
}

}  // namespace

fs::path asset_file(Builder& builder, Reader& r, std::string_view key, const std::string& kind) {
  const std::string name = r.text(key);
  std::error_code ignored;
  fs::path file = builder.folder / name;
  if (!fs::is_regular_file(file, ignored)) file = home_folder() / name;
  if (!fs::is_regular_file(file, ignored)) {
    r.fail(key, fmt::format("must be {}; there is no {} and no {}", kind, (builder.folder / name).string(), file.string()));
    return {};
  }
  if (may_read(builder, file)) return file;
  r.fail(key, fmt::format("lies outside the scene's folder; where you trust the scene, give --allow {}",
                          fs::weakly_canonical(file, ignored).parent_path().string()));
  return {};
}

}  // namespace scenes
