// Hash of the recording of every shipped scene and hard case, as given and under the other schemes and laws: what a change that
// should change no bit is held against. `recording_hashes [--window SECONDS] [part of a path]...`; two lists are compared by diff.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include "engine/simulate.h"
#include "scenes/scene.h"

namespace fs = std::filesystem;

namespace {

struct Variant {
  const char* name;
  std::vector<std::string> overrides;
  double window;  // [s]
};

const std::vector<Variant> kVariants = {
    {"as given", {}, 1e9},
    {"compliant", {"simulation.contact_law=compliant"}, 0.4},
    {"rk4 compliant", {"simulation.contact_law=compliant", "simulation.scheme=rk4"}, 0.25},
    {"adaptive compliant", {"simulation.contact_law=compliant", "simulation.scheme=adaptive"}, 0.15},
    {"sleep", {"simulation.sleep=true"}, 3},
};

std::vector<fs::path> all_scenes(const fs::path& root) {
  std::vector<fs::path> out;
  for (const char* folder : {"scenes/cases", "scenes/gallery", "tests/hard_cases"})
    for (const auto& entry : fs::directory_iterator(root / folder))
      if (entry.path().extension() == ".toml") out.push_back(entry.path());
  std::sort(out.begin(), out.end());
  return out;
}

void print_hash(const fs::path& path, const std::string& name, const Variant& variant, double window) {
  engine::Model model;
  try {
    model = scenes::load(path, variant.overrides).model;
  } catch (const std::exception&) {
    std::printf("%-18s %-60s refused\n", variant.name, name.c_str());
    return;
  }
  model.settings.duration = std::min({model.settings.duration, window, variant.window});
  const engine::Recording run = engine::simulate(model);
  const engine::Diagnostics& d = run.diagnostics;
  std::printf("%-18s %-60s %016llx %zu events %ld sweeps %ld substeps %zu warnings%s\n", variant.name, name.c_str(),
              static_cast<unsigned long long>(engine::hash(run)), run.events.size(), d.contact_sweeps, d.substeps,
              d.warnings.size(), run.failure ? (" ended: " + run.failure->message).c_str() : "");
  std::fflush(stdout);
}

}  // namespace

int main(int count, char** arguments) {
  double window = 1e9;
  std::vector<std::string> parts;
  for (int i = 1; i < count; ++i) {
    const std::string argument = arguments[i];
    if (argument == "--window" && i + 1 < count)
      window = std::atof(arguments[++i]);
    else
      parts.push_back(argument);
  }
  const fs::path root = CRASHREEL_SOURCE_DIR;
  for (const fs::path& path : all_scenes(root)) {
    const std::string name = fs::relative(path, root).string();
    const auto named = [&name](const std::string& part) { return name.find(part) != std::string::npos; };
    if (!parts.empty() && std::none_of(parts.begin(), parts.end(), named)) continue;
    for (const Variant& variant : kVariants) print_hash(path, name, variant, window);
  }
  return 0;
}
