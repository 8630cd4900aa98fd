// Who may know whom: reads every #include of the tree and holds it against the walls of the house.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::IsEmpty;
using testing::SizeIs;

namespace {

/// What the files under `folder` may include of the tree. The longest folder that fits a file decides.
struct Wall {
  std::string folder;
  std::vector<std::string> may_include;
};

const std::vector<Wall> kWalls = {
    // inside the engine: from what knows nothing to what runs it all
    {"engine/", {"engine/"}},
    {"engine/math/", {"engine/math/"}},
    {"engine/geometry/", {"engine/geometry/", "engine/math/"}},
    {"engine/laws/", {"engine/laws/", "engine/math/"}},
    {"engine/model/", {"engine/model/", "engine/geometry/", "engine/math/"}},
    {"engine/joints/", {"engine/joints/", "engine/model/", "engine/math/"}},
    {"engine/solver/", {"engine/solver/", "engine/joints/", "engine/model/", "engine/geometry/", "engine/laws/", "engine/math/"}},
    {"engine/contact/",
     {"engine/contact/", "engine/solver/", "engine/model/", "engine/geometry/", "engine/laws/", "engine/math/", "engine/state.h",
      "engine/world.h"}},
    {"engine/effects/",
     {"engine/effects/", "engine/contact/", "engine/solver/", "engine/joints/", "engine/model/", "engine/geometry/", "engine/laws/",
      "engine/math/", "engine/state.h", "engine/world.h", "engine/step_context.h"}},
    {"engine/step/",
     {"engine/step/", "engine/effects/effect.h", "engine/contact/mean_friction.h", "engine/solver/", "engine/laws/", "engine/math/",
      "engine/divergence.h", "engine/world.h", "engine/step_context.h"}},
    {"engine/record/",
     {"engine/record/", "engine/effects/effect.h", "engine/effects/words.h", "engine/measure/parties.h", "engine/solver/",
      "engine/joints/", "engine/math/", "engine/world.h"}},
    {"engine/measure/", {"engine/measure/", "engine/model/", "engine/geometry/", "engine/math/", "engine/recording.h"}},
    {"render/", {"render/", "engine/recording.h", "engine/math/", "engine/geometry/"}},
    {"render/overlays/",
     {"render/overlays/", "render/draw_list.h", "render/stage.h", "render/arrange.h", "render/matrix.h", "engine/recording.h",
      "engine/math/", "engine/geometry/"}},
    {"scenes/", {"scenes/", "render/stage.h", "render/surface/simplify.h", "engine/"}},
    {"scenes/cage/", {"scenes/cage/"}},
    {"cli/", {"cli/", "scenes/", "render/", "engine/"}},
};

/// Libraries, and the only places that see them.
struct Library {
  std::string header;  // a regular expression over what stands between the brackets
  std::vector<std::string> seen_by;
};

const std::vector<Library> kLibraries = {
    {"Eigen/.*", {"engine/", "render/", "scenes/", "cli/"}},
    {"sleef\\.h", {"engine/math/functions.cpp"}},
    {"GL/.*|EGL/.*", {"render/gl/"}},
    {"immintrin\\.h", {"render/shade/lanes.h"}},
    {"dlfcn\\.h", {"render/late_library.cpp", "cli/allocation.cpp"}},
    {"lib(av|sw).*", {"render/video/"}},
    {"nettle/sha2\\.h", {"scenes/loader/sha256.cpp"}},
    {"png\\.h|zlib\\.h|libdeflate\\.h", {"render/image/"}},
    {"cairo.*|pango.*|ft2build\\.h|freetype.*|fontconfig.*",
     {"render/text/", "render/figures/", "render/charts/", "render/paper_file.h"}},
    {"toml\\+\\+.*|toml\\.hpp", {"scenes/loader/toml.cpp"}},
    {"assimp/.*", {"scenes/cage/"}},
    {"seccomp\\.h", {"scenes/cage/"}},
    {"execinfo\\.h", {"cli/process.cpp"}},
    {"link\\.h", {"cli/commands/version.cpp", "cli/build_id.cpp"}},
    {"CLI/.*", {"cli/command.cpp"}},
    {"boost/.*", {"cli/inference/"}},
    {"nlohmann/.*", {"scenes/", "cli/"}},
    {"fmt/.*", {"render/", "scenes/", "cli/"}},
    {"linux/.*|sys/.*|malloc\\.h|unistd\\.h|fcntl\\.h|poll\\.h|semaphore\\.h|signal\\.h|sched\\.h|fnmatch\\.h",
     {"render/", "scenes/", "cli/"}},
    // the engine knows no files, no text output, no clock, no threads, no order that depends on addresses, no chance
    {"(iostream|ostream|istream|fstream|cstdio|filesystem|chrono|ctime|thread|mutex|future|atomic|condition_variable|random"
     "|unordered_map|unordered_set)",
     {"render/", "scenes/", "cli/"}},
};

struct Include {
  bool ours = false;  // in quotes
  std::string target;
};

std::vector<Include> includes_of(const std::string& text) {
  static const std::regex kLine(R"(^\s*#\s*include\s*([<"])([^>"]+)[>"])");
  std::vector<Include> out;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    std::smatch found;
    if (std::regex_search(line, found, kLine)) out.push_back({found[1] == "\"", found[2]});
  }
  return out;
}

bool starts_with_any(const std::string& text, const std::vector<std::string>& beginnings) {
  return std::any_of(beginnings.begin(), beginnings.end(), [&text](const std::string& b) { return text.starts_with(b); });
}

/// A header of the language: no folder, no ending.
bool is_standard(const std::string& header) {
  return header.find_first_of("/.") == std::string::npos;
}

std::vector<std::string> broken_walls(const std::string& file, const std::string& text) {
  std::vector<std::string> out;
  const Wall* wall = nullptr;
  for (const Wall& candidate : kWalls) {
    if (file.starts_with(candidate.folder) && (!wall || candidate.folder.size() > wall->folder.size())) wall = &candidate;
  }
  if (!wall) return {file + " stands in no room"};
  for (const Include& include : includes_of(text)) {
    if (include.ours) {
      if (!starts_with_any(include.target, wall->may_include)) out.push_back(file + " includes " + include.target);
      continue;
    }
    bool known = false;
    for (const Library& library : kLibraries) {
      if (!std::regex_match(include.target, std::regex(library.header))) continue;
      known = true;
      if (!starts_with_any(file, library.seen_by)) out.push_back(file + " includes <" + include.target + ">");
    }
    if (!known && !is_standard(include.target))
      out.push_back(file + " includes <" + include.target + ">, which no room is allowed");
  }
  return out;
}

/// Lines that take a function from the C library, or from Eigen that does, whose last bits depend on the processor. What a
/// recording depends on calls those of engine/math/functions.h.
std::vector<std::string> undefined_bits(const std::string& file, const std::string& text) {
  std::vector<std::string> out;
  if (file.starts_with("engine/math/functions.") || !starts_with_any(file, {"engine/", "scenes/"})) return out;
  static const std::regex kCall(
      R"((^|[^\w:.>])(std::|::)?(a?(sin|cos|tan)h?|atan2|exp(2|m1)?|log(2|10|1p)?|pow|cbrt|hypot|[tl]gamma|erfc?)f?\()"
      R"(|AngleAxis|eulerAngles|[.>](slerp|angularDistance|stableNorm|computeDirect)\(|Rotation2D)");
  std::istringstream lines(text);
  int number = 0;
  for (std::string line; std::getline(lines, line);) {
    ++number;
    const std::string code = line.substr(0, line.find("//"));
    if (std::regex_search(code, kCall)) out.push_back(file + ":" + std::to_string(number) + ": " + line);
  }
  return out;
}

/// The folder of a file, "engine/solver" of "engine/solver/topology.h".
std::string folder_of(const std::string& file) {
  return file.substr(0, file.find_last_of('/'));
}

/// Pairs of folders below `room` whose files include each other's, in either direction and by any way round.
std::vector<std::string> folder_circles(const std::map<std::string, std::string>& files, const std::string& room) {
  std::map<std::string, std::set<std::string>> knows;
  for (const auto& [file, text] : files)
    for (const Include& include : includes_of(text)) {
      const std::string from = folder_of(file), to = folder_of(include.target);
      if (include.ours && from != to && from.starts_with(room + "/") && to.starts_with(room + "/")) knows[from].insert(to);
    }
  for (bool any = true; any;) {  // whom one's acquaintances know
    any = false;
    for (auto& [from, direct] : knows)
      for (const std::string& by : std::set<std::string>(direct))
        for (const std::string& to : knows.contains(by) ? std::set<std::string>(knows.at(by)) : std::set<std::string>{})
          any = direct.insert(to).second || any;
  }
  std::vector<std::string> out;
  for (const auto& [from, all] : knows)
    if (all.contains(from)) out.push_back(from);
  return out;
}

/// Every source file of the product by its path from the root.
std::map<std::string, std::string> sources() {
  std::map<std::string, std::string> out;
  const fs::path root = CRASHREEL_SOURCE_DIR;
  for (const char* room : {"engine", "render", "scenes", "cli"}) {
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(root / room)) {
      const std::string extension = entry.path().extension().string();
      if (extension != ".h" && extension != ".cpp") continue;
      std::ostringstream text;
      text << std::ifstream(entry.path()).rdbuf();
      out[fs::relative(entry.path(), root).string()] = text.str();
    }
  }
  return out;
}

/// The first circle of includes found from `file` on, as a text; empty when there is none.
std::string circle_from(const std::string& file, const std::map<std::string, std::string>& files, std::vector<std::string>& path,
                        std::set<std::string>& done) {
  const auto before = std::find(path.begin(), path.end(), file);
  if (before != path.end()) {
    std::string text;
    for (auto it = before; it != path.end(); ++it) text += *it + " -> ";
    return text + file;
  }
  const auto found = files.find(file);
  if (found == files.end() || done.contains(file)) return "";
  path.push_back(file);
  for (const Include& include : includes_of(found->second)) {
    const std::string circle = include.ours ? circle_from(include.target, files, path, done) : "";
    if (!circle.empty()) return circle;
  }
  path.pop_back();
  done.insert(file);
  return "";
}

std::vector<std::string> circles(const std::map<std::string, std::string>& files) {
  std::vector<std::string> out;
  std::set<std::string> done;
  for (const auto& [file, text] : files) {
    std::vector<std::string> path;
    const std::string circle = circle_from(file, files, path, done);
    if (circle.empty()) continue;
    out.push_back(circle);
    done.insert(path.begin(), path.end());  // told once, not again from each of its files
  }
  return out;
}

}  // namespace

TEST(Layering, NoFileIncludesWhatItsRoomMayNotKnow) {
  const auto files = sources();
  ASSERT_GT(files.size(), 20U) << "the tree was not found";
  std::vector<std::string> broken;
  for (const auto& [file, text] : files) {
    for (const std::string& line : broken_walls(file, text)) broken.push_back(line);
  }
  EXPECT_THAT(broken, IsEmpty());
}

TEST(Layering, NoHeadersIncludeEachOtherInACircle) {
  EXPECT_THAT(circles(sources()), IsEmpty());
}

TEST(Layering, NoFoldersOfTheEngineKnowEachOtherInACircle) {
  EXPECT_THAT(folder_circles(sources(), "engine"), IsEmpty());
}

TEST(Layering, EveryIncludeOfOursNamesAFileThatIsThere) {
  const auto files = sources();
  std::vector<std::string> missing;
  for (const auto& [file, text] : files) {
    for (const Include& include : includes_of(text)) {
      if (include.ours && !files.contains(include.target)) missing.push_back(file + " includes " + include.target);
    }
  }
  EXPECT_THAT(missing, IsEmpty());
}

TEST(Layering, WhatARecordingDependsOnCallsNoFunctionOfUndefinedBits) {
  std::vector<std::string> found;
  for (const auto& [file, text] : sources())
    for (const std::string& line : undefined_bits(file, text)) found.push_back(line);
  EXPECT_THAT(found, IsEmpty());
}

// the checker itself: a wall that lets everything through would pass the tests above

TEST(LayeringChecker, SeesAnArrowUpward) {
  EXPECT_THAT(broken_walls("engine/step.cpp", "#include \"render/stage.h\"\n"),
              ElementsAre("engine/step.cpp includes render/stage.h"));
  EXPECT_THAT(broken_walls("render/film.cpp", "#include \"engine/model/model.h\"\n"), SizeIs(1));
  EXPECT_THAT(broken_walls("scenes/loader/film.cpp", "#include \"render/film.h\"\n"), SizeIs(1));
  EXPECT_THAT(broken_walls("engine/laws/friction.h", "#include \"engine/model/model.h\"\n"), SizeIs(1));
  EXPECT_THAT(broken_walls("attic/x.cpp", ""), SizeIs(1));
}

TEST(LayeringChecker, SeesALibraryWhereItDoesNotBelong) {
  EXPECT_THAT(broken_walls("engine/step.cpp", "#include <fmt/format.h>\n"), SizeIs(1));
  EXPECT_THAT(broken_walls("engine/step.cpp", "  # include <chrono>\n"), SizeIs(1));
  EXPECT_THAT(broken_walls("render/film.cpp", "#include <GL/osmesa.h>\n"), SizeIs(1));
  EXPECT_THAT(broken_walls("cli/main.cpp", "#include <boost/any.hpp>\n"), SizeIs(1));
  EXPECT_THAT(broken_walls("engine/step.cpp", "#include <vector>\n#include <Eigen/Core>\n#include \"engine/state.h\"\n"),
              IsEmpty());
}

TEST(LayeringChecker, SeesAFunctionOfUndefinedBits) {
  for (const char* line : {"x = std::sin(a);", "x = 2 * ::pow(a, b);", "cos(a)", "return hypot(x, y);",
                           "q = Eigen::AngleAxisd(a, n);", "a.slerp(s, b)", "std::expm1(x)", "std::acosh(x)", "powf(a, b)"})
    EXPECT_THAT(undefined_bits("engine/step.cpp", line), SizeIs(1)) << line;
  for (const char* line : {"x = math::sin(a);", "engine::math::pow(a, b)", "// std::sin(a)", "combined.cos(x)", "explain(x)"})
    EXPECT_THAT(undefined_bits("scenes/loader/body.cpp", line), IsEmpty()) << line;
  EXPECT_THAT(undefined_bits("render/film.cpp", "x = std::sin(a);"), IsEmpty()) << "pictures are compared within limits";
}

TEST(LayeringChecker, SeesACircleOfFolders) {
  const std::map<std::string, std::string> two = {{"engine/a/x.h", "#include \"engine/b/y.h\"\n"},
                                                  {"engine/b/z.h", "#include \"engine/a/w.h\"\n"}};
  EXPECT_THAT(folder_circles(two, "engine"), ElementsAre("engine/a", "engine/b"));
  EXPECT_THAT(folder_circles({{"engine/a/x.h", "#include \"engine/b/y.h\"\n"}}, "engine"), IsEmpty());
}

TEST(LayeringChecker, SeesACircle) {
  EXPECT_THAT(circles({{"a.h", "#include \"b.h\"\n"}, {"b.h", "#include \"c.h\"\n"}, {"c.h", "#include \"a.h\"\n"}}),
              ElementsAre("a.h -> b.h -> c.h -> a.h"));
  EXPECT_THAT(circles({{"a.h", "#include \"b.h\"\n#include \"c.h\"\n"}, {"b.h", "#include \"c.h\"\n"}, {"c.h", ""}}), IsEmpty());
}
