// crashreel library: what a scene can name, by kind.
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>

#include "cli/command.h"
#include "cli/exit.h"
#include "cli/output/json.h"
#include "scenes/loader/builder.h"
#include "scenes/loader/value.h"

namespace cli {
namespace {

namespace fs = std::filesystem;

using Names = std::map<std::string, std::vector<std::string>>;

/// The entries of the library's folders: persons, poses, vehicles ...
Names library_entries(const fs::path& library) {
  if (!fs::is_directory(library)) throw MachineError(fmt::format("reading the library {}: no such folder", library.string()));
  Names names;
  for (const fs::directory_entry& kind : fs::directory_iterator(library)) {
    if (!kind.is_directory()) continue;
    std::vector<std::string>& entries = names[kind.path().filename().string()];
    for (const fs::directory_entry& file : fs::directory_iterator(kind.path())) {
      if (file.path().extension() == ".toml") entries.push_back(file.path().stem().string());
    }
    std::sort(entries.begin(), entries.end());
  }
  return names;
}

/// What an entry is, in its own words: "Van, 2500 kg".
std::string title_in(const fs::path& entry) {
  const scenes::Value content = scenes::parse_file(entry);
  const scenes::Value* title = content.find("title");
  return title ? title->text : "";
}

int library(bool json) {
  const fs::path folder = scenes::home_folder() / "scenes" / "library";
  const Names names = library_entries(folder);
  if (json) {
    fmt::print("{}\n", json_text(Json(names)));
    return kDone;
  }
  for (const auto& [kind, entries] : names) {
    fmt::print("{}\n", kind);
    for (const std::string& entry : entries) fmt::print("  {:<15}  {}\n", entry, title_in(folder / kind / (entry + ".toml")));
  }
  return kDone;
}

}  // namespace

std::function<int()> declare_library(Arguments& arguments) {
  const auto json = std::make_shared<bool>(false);
  arguments.flag("--json", *json, "print as JSON");
  return [json] { return library(*json); };
}

}  // namespace cli
