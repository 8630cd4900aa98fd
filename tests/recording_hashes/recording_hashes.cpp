// Hashes of recordings: what a change that should change no bit is held against, and what every processor, compiler and library
// must find alike.
//   recording_hashes [PART OF A PATH]...   every shipped scene and hard case, as given and under the other schemes and laws
//     --given         as given only
//     --window S      the first S seconds
//     --accidents N   random accidents 0 to N - 1 instead (tests/hard_cases/accident.h)
//   recording_hashes --reference           the table of the shipped scenes anew: > tests/recording_hashes/reference.txt
//   recording_hashes --check FILE          the shipped scenes against that table
//     --begin         their first part only
//     --shard I/N     every N-th of them
// Two lists are compared by diff; `combinations/run` does it for compilers, libraries and processors.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <string>
#include <vector>

#include "engine/simulate.h"
#include "scenes/scene.h"
#include "tests/hard_cases/accident.h"
#include "tests/scenes/scene_file.h"

namespace fs = std::filesystem;

namespace {

constexpr double kWhole = 1e9;   // [s]
constexpr double kBegin = 0.25;  // [s] under sanitizers too a matter of seconds; the persons of most cases are struck by then

struct Variant {
  const char* name;
  std::vector<std::string> overrides;
  double window;  // [s]
};

const std::vector<Variant> kVariants = {
    {"as given", {}, kWhole},
    {"compliant", {"simulation.contact_law=compliant"}, 0.4},
    {"rk4 compliant", {"simulation.contact_law=compliant", "simulation.scheme=rk4"}, 0.25},
    {"adaptive compliant", {"simulation.contact_law=compliant", "simulation.scheme=adaptive"}, 0.15},
    {"sleep", {"simulation.sleep=true"}, 3},
};

struct Wish {
  bool given = false, reference = false, begin = false;
  double window = kWhole;  // [s]
  int accidents = 0;
  std::string check;
  std::size_t shard = 0, shards = 1;
  std::vector<std::string> parts;
};

std::vector<std::string> scenes_in(const std::vector<const char*>& folders) {
  const fs::path root = CRASHREEL_SOURCE_DIR;
  std::vector<std::string> out;
  for (const char* folder : folders)
    for (const auto& entry : fs::directory_iterator(root / folder))
      if (entry.path().extension() == ".toml") out.push_back(fs::relative(entry.path(), root).string());
  std::sort(out.begin(), out.end());
  return out;
}

engine::Recording run(engine::Model model, double window) {
  model.settings.duration = std::min(model.settings.duration, window);
  return engine::simulate(model);
}

std::string hash_of(const engine::Recording& recording) {
  char out[17];
  std::snprintf(out, sizeof out, "%016llx", static_cast<unsigned long long>(engine::hash(recording)));
  return out;
}

void print_hash(const std::string& how, const std::string& name, const engine::Recording& run) {
  const engine::Diagnostics& d = run.diagnostics;
  std::printf("%-18s %-60s %s %zu events %ld sweeps %ld substeps %zu warnings%s\n", how.c_str(), name.c_str(), hash_of(run).c_str(),
              run.events.size(), d.contact_sweeps, d.substeps, d.warnings.size(),
              run.failure ? (" ended: " + run.failure->message).c_str() : "");
  std::fflush(stdout);
}

int list_scenes(const Wish& wish) {
  for (const std::string& name : scenes_in({"scenes/cases", "scenes/gallery", "tests/hard_cases"})) {
    const auto named = [&name](const std::string& part) { return name.find(part) != std::string::npos; };
    if (!wish.parts.empty() && std::none_of(wish.parts.begin(), wish.parts.end(), named)) continue;
    for (const Variant& variant : kVariants) {
      if (wish.given && !variant.overrides.empty()) continue;
      engine::Model model;
      try {
        model = scenes::load(fs::path(CRASHREEL_SOURCE_DIR) / name, variant.overrides).model;
      } catch (const std::exception&) {
        std::printf("%-18s %-60s refused\n", variant.name, name.c_str());
        continue;
      }
      print_hash(variant.name, name, run(std::move(model), std::min(wish.window, variant.window)));
    }
  }
  return 0;
}

int list_accidents(const Wish& wish) {
  const scenes::testing::SceneFolder folder;
  for (int seed = 0; seed < wish.accidents; ++seed)
    for (const char* law : {"default_auto", "persons_yield"})
      print_hash(law, "accident " + std::to_string(seed),
                 run(folder.load(hard_cases::accident(static_cast<unsigned>(seed), law)).model, wish.window));
  return 0;
}

struct Reference {
  std::string begin, whole;
};

Reference reference_of(const std::string& name, bool begin, bool whole) {
  const engine::Model model = scenes::load(fs::path(CRASHREEL_SOURCE_DIR) / name).model;
  return {begin ? hash_of(run(model, kBegin)) : "", whole ? hash_of(run(model, kWhole)) : ""};
}

int print_reference() {
  std::printf("# Hash of every shipped scene's recording: its first %g s, the whole, the scene.\n", kBegin);
  std::printf("# After a wanted change: build/tests/recording_hashes --reference > tests/recording_hashes/reference.txt\n");
  for (const std::string& name : scenes_in({"scenes/cases", "scenes/gallery"})) {
    const Reference hashes = reference_of(name, true, true);
    std::printf("%s %s %s\n", hashes.begin.c_str(), hashes.whole.c_str(), name.c_str());
    std::fflush(stdout);
  }
  return 0;
}

int check(const Wish& wish) {
  std::map<std::string, Reference> table;
  std::ifstream in(wish.check);
  for (std::string line; std::getline(in, line);)
    if (line.size() > 34 && line[0] != '#') table[line.substr(34)] = {line.substr(0, 16), line.substr(17, 16)};
  const std::vector<std::string> names = scenes_in({"scenes/cases", "scenes/gallery"});
  int wrong = 0;
  for (const auto& [name, hashes] : table)
    if (!std::binary_search(names.begin(), names.end(), name)) {
      std::printf("%s: in the table, but no scene\n", name.c_str());
      ++wrong;
    }
  for (std::size_t i = wish.shard; i < names.size(); i += wish.shards) {
    const auto wanted = table.find(names[i]);
    const Reference found = reference_of(names[i], wish.begin, !wish.begin);
    if (wanted != table.end() && (wish.begin ? found.begin == wanted->second.begin : found.whole == wanted->second.whole)) continue;
    std::printf("%s: %s; the table says %s\n", names[i].c_str(), (wish.begin ? found.begin : found.whole).c_str(),
                wanted == table.end() ? "nothing" : (wish.begin ? wanted->second.begin : wanted->second.whole).c_str());
    ++wrong;
  }
  if (wrong > 0)
    std::printf("Where that is wanted: build/tests/recording_hashes --reference > tests/recording_hashes/reference.txt\n");
  return wrong == 0 ? 0 : 1;
}

Wish wish_of(int count, char** arguments) {
  Wish out;
  for (int i = 1; i < count; ++i) {
    const std::string argument = arguments[i];
    const bool more = i + 1 < count;
    if (argument == "--given")
      out.given = true;
    else if (argument == "--reference")
      out.reference = true;
    else if (argument == "--begin")
      out.begin = true;
    else if (argument == "--window" && more)
      out.window = std::atof(arguments[++i]);
    else if (argument == "--accidents" && more)
      out.accidents = std::atoi(arguments[++i]);
    else if (argument == "--check" && more)
      out.check = arguments[++i];
    else if (argument == "--shard" && more)
      std::sscanf(arguments[++i], "%zu/%zu", &out.shard, &out.shards);
    else
      out.parts.push_back(argument);
  }
  return out;
}

}  // namespace

int main(int count, char** arguments) {
  const Wish wish = wish_of(count, arguments);
  if (wish.reference) return print_reference();
  if (!wish.check.empty()) return check(wish);
  return wish.accidents > 0 ? list_accidents(wish) : list_scenes(wish);
}
