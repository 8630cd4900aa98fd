#include "render/late_library.h"

#include <dlfcn.h>
#include <fmt/format.h>
#include <signal.h>

#include <array>

#include "render/error.h"

namespace render {
namespace {

void (*end_failed_load)(int) = SIG_DFL;

/// While it lives the program ends by end_failed_load.
class LoadingLibrary {
 public:
  LoadingLibrary() {
    struct sigaction action {};
    action.sa_handler = end_failed_load;
    for (std::size_t i = 0; i < kFailures.size(); ++i) sigaction(kFailures[i], &action, &before_[i]);
  }
  ~LoadingLibrary() {
    for (std::size_t i = 0; i < kFailures.size(); ++i) sigaction(kFailures[i], &before_[i], nullptr);
  }
  LoadingLibrary(const LoadingLibrary&) = delete;
  LoadingLibrary& operator=(const LoadingLibrary&) = delete;

 private:
  static constexpr std::array kFailures{SIGABRT, SIGSEGV, SIGBUS};
  std::array<struct sigaction, kFailures.size()> before_{};
};

void* load(const char* library) {
  const LoadingLibrary loading;
  return dlopen(library, RTLD_LAZY);  // never closed: what it set up stays
}

}  // namespace

void end_failed_load_by(void (*end)(int)) {
  end_failed_load = end;
}

void* late_function(const char* library, const char* function) {
  void* const handle = load(library);
  void* const found = handle ? dlsym(handle, function) : nullptr;
  if (!found) throw RenderError(fmt::format("cannot load {}: {}", library, dlerror()));
  return found;
}

}  // namespace render
