#include "render/late_library.h"

#include <dlfcn.h>
#include <fmt/format.h>

#include <atomic>

#include "render/error.h"

namespace render {
namespace {

std::atomic<bool> loading = false;

}  // namespace

bool is_loading_library() {
  return loading;
}

void* late_function(const char* library, const char* function) {
  loading = true;
  void* const handle = dlopen(library, RTLD_LAZY);  // never closed: what it set up stays
  loading = false;
  void* const found = handle ? dlsym(handle, function) : nullptr;
  if (!found) throw RenderError(fmt::format("cannot load {}: {}", library, dlerror()));
  return found;
}

}  // namespace render
