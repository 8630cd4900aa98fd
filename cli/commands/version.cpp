// crashreel version: what a report must name to be repeatable.
#include <fmt/format.h>

#include <memory>
#include <nlohmann/json.hpp>

#include "cli/command.h"
#include "cli/commit.h"
#include "cli/exit.h"
#include "render/renderer.h"

namespace cli {
namespace {

#if defined(__clang__)
constexpr const char* kCompiler = "clang " __clang_version__;
#else
constexpr const char* kCompiler = "g++ " __VERSION__;
#endif

const char*& commit() {
  static const char* name = "";
  return name;
}

int version(bool json, const std::string& gl_wanted) {
  render::choose_gl(gl_wanted);
  const std::string build = fmt::format("{}, {}", CRASHREEL_BUILD, kCompiler);
  const std::string gl = render::gl_description();
  if (json) {
    fmt::print(
        "{}\n",
        nlohmann::ordered_json{
            {"version", CRASHREEL_VERSION}, {"commit", commit()}, {"build", build}, {"libraries", CRASHREEL_LIBRARIES}, {"gl", gl}}
            .dump(2));
  } else {
    const std::string from = *commit() ? fmt::format(" ({})", commit()) : "";
    fmt::print("crashreel {}{}\nbuild      {}\nlibraries  {}\ngl         {}\n", CRASHREEL_VERSION, from, build, CRASHREEL_LIBRARIES,
               gl);
  }
  return kDone;
}

}  // namespace

void set_commit(const char* name) {
  commit() = name;
}

std::function<int()> declare_version(Arguments& arguments) {
  const auto json = std::make_shared<bool>(false);
  const auto gl = std::make_shared<std::string>("osmesa");
  arguments.flag("--json", *json, "print as JSON");
  arguments.choice("--gl", *gl, {"osmesa", "egl"}, "which OpenGL to ask");
  return [json, gl] { return version(*json, *gl); };
}

}  // namespace cli
