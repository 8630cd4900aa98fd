#include "cli/output/fingerprint.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string_view>

#include "scenes/loader/sha256.h"

namespace cli {
namespace {

/// Options that say where, how fast and how loud; --set and --effects stand in the scene's own hash.
constexpr std::array<std::string_view, 15> kIndifferent{"--output",  "--jobs",    "--overwrite",    "--resume",  "--quiet",
                                                        "--verbose", "--json",    "--progress",     "--dry-run", "--max-memory",
                                                        "--set",     "--effects", "--list-cameras", "--timings", "--allow"};
/// Options that choose among the frames of a film.
constexpr std::array<std::string_view, 4> kChoosing{"--from", "--to", "--frames", "--at"};

bool among(const auto& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

}  // namespace

std::string fingerprint(ResultKind kind, const scenes::Scene& scene, const Arguments& arguments,
                        std::optional<std::uint64_t> recording) {
  std::string all = CRASHREEL_VERSION "\n" CRASHREEL_LIBRARIES "\n" + scene.sha256 + "\n" + scene.assets_sha256 + "\n";
  if (recording) all += fmt::format("{:016x}\n", *recording);
  for (const auto& [name, value] : arguments.given()) {
    if (among(kIndifferent, name) || (kind == ResultKind::frame && among(kChoosing, name))) continue;
    all += name + '\0' + value + '\0';
  }
  return scenes::sha256(all);
}

}  // namespace cli
