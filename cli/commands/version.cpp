// crashreel version: what a report must name to be repeatable.
#include <fmt/format.h>
#include <link.h>

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

bool binds_at_start() {
  for (const ElfW(Dyn)* entry = _DYNAMIC; entry->d_tag != DT_NULL; ++entry)
    if (entry->d_tag == DT_FLAGS_1 && (entry->d_un.d_val & DF_1_NOW) != 0) return true;
  return false;
}

/// Whether the tables of the linker in the program itself, which is told first, are read-only once it runs.
int relocations_read_only(dl_phdr_info* object, std::size_t, void* found) {
  for (int i = 0; i < object->dlpi_phnum; ++i)
    if (object->dlpi_phdr[i].p_type == PT_GNU_RELRO) *static_cast<bool*>(found) = true;
  return 1;
}

/// What stands against what a foreign file could bring a library to do; read off the compiler's words and the program itself.
std::string hardening() {
  std::vector<std::string> out;
#if defined(_FORTIFY_SOURCE) && defined(__OPTIMIZE__)
  out.push_back(fmt::format("fortify {}", _FORTIFY_SOURCE));
#endif
#if defined(__SSP_STRONG__)
  out.emplace_back("stack protector strong");
#endif
#if defined(__PIE__)
  out.emplace_back("PIE");
#endif
  bool relro = false;
  dl_iterate_phdr(relocations_read_only, &relro);
  if (relro) out.emplace_back(binds_at_start() ? "full RELRO" : "partial RELRO");
  return out.empty() ? "none" : fmt::format("{}", fmt::join(out, ", "));
}

const char*& commit() {
  static const char* name = "";
  return name;
}

int version(bool json, const std::string& gl_wanted) {
  render::choose_gl(gl_wanted);
  const std::string build = fmt::format("{}, {}", CRASHREEL_BUILD, kCompiler);
  const std::string gl = render::gl_description();
  if (json) {
    fmt::print("{}\n", nlohmann::ordered_json{{"version", CRASHREEL_VERSION},
                                              {"commit", commit()},
                                              {"build", build},
                                              {"hardening", hardening()},
                                              {"libraries", CRASHREEL_LIBRARIES},
                                              {"gl", gl}}
                           .dump(2));
  } else {
    const std::string from = *commit() ? fmt::format(" ({})", commit()) : "";
    fmt::print("crashreel {}{}\nbuild      {}\nhardening  {}\nlibraries  {}\ngl         {}\n", CRASHREEL_VERSION, from, build,
               hardening(), CRASHREEL_LIBRARIES, gl);
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
