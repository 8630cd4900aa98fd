#include "render/late_library.h"

#include <dlfcn.h>
#include <fmt/format.h>

#include "render/error.h"

namespace render {

void* late_function(const char* library, const char* function) {
  void* const handle = dlopen(library, RTLD_LAZY);  // never closed: what it set up stays
  void* const found = handle ? dlsym(handle, function) : nullptr;
  if (!found) throw RenderError(fmt::format("cannot load {}: {}", library, dlerror()));
  return found;
}

}  // namespace render
