#include "cli/allocation.h"

#include <dlfcn.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <exception>
#include <string_view>

#include "cli/exit.h"
#include "render/gl/context.h"

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define CRASHREEL_OWN_ALLOCATOR
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer) || __has_feature(memory_sanitizer)
#define CRASHREEL_OWN_ALLOCATOR
#endif
#endif

namespace cli {
namespace {

bool draws = false;
bool ended = false;  // memory did, once

[[noreturn]] void end(std::string_view why) {
  [[maybe_unused]] const auto written = write(STDERR_FILENO, why.data(), why.size());
  _exit(kMachineFailed);
}

/// What was thrown where nothing may be is not known here.
[[noreturn]] void terminate() {
  if (ended) end("crashreel: not enough memory\n");
  std::abort();
}

}  // namespace

void end_where_memory_ends() {
  render::GlContext::on_open = [] { draws = true; };
  std::set_terminate(terminate);
}

}  // namespace cli

#ifndef CRASHREEL_OWN_ALLOCATOR
namespace {

/// What the program calls; the C library's unless another one was loaded before it.
template <class Function>
Function next_of(const char* name) {
  return reinterpret_cast<Function>(dlsym(RTLD_NEXT, name));
}

void* given(void* memory, std::size_t size) {
  if (memory || size == 0) return memory;
  cli::ended = true;
  if (cli::draws) cli::end("crashreel: not enough memory to draw\n");
  return nullptr;
}

}  // namespace

// The program's own come before those of every library, and hand on what they are asked.
extern "C" {

void* __libc_malloc(std::size_t);
void* __libc_calloc(std::size_t, std::size_t);

void* malloc(std::size_t size) noexcept {
  static bool looking = false;  // dlsym may allocate
  static void* (*next)(std::size_t) = nullptr;
  if (!next) {
    if (looking) return __libc_malloc(size);
    looking = true;
    next = next_of<void* (*)(std::size_t)>("malloc");
  }
  return given(next(size), size);
}

void* calloc(std::size_t count, std::size_t size) noexcept {
  static bool looking = false;
  static void* (*next)(std::size_t, std::size_t) = nullptr;
  if (!next) {
    if (looking) return __libc_calloc(count, size);
    looking = true;
    next = next_of<void* (*)(std::size_t, std::size_t)>("calloc");
  }
  return given(next(count, size), count * size);
}

void* realloc(void* old, std::size_t size) noexcept {
  static const auto next = next_of<void* (*)(void*, std::size_t)>("realloc");
  return given(next(old, size), size);
}

int posix_memalign(void** out, std::size_t alignment, std::size_t size) noexcept {
  static const auto next = next_of<int (*)(void**, std::size_t, std::size_t)>("posix_memalign");
  const int error = next(out, alignment, size);
  if (error == ENOMEM) given(nullptr, size);
  return error;
}

void* aligned_alloc(std::size_t alignment, std::size_t size) noexcept {
  static const auto next = next_of<void* (*)(std::size_t, std::size_t)>("aligned_alloc");
  return given(next(alignment, size), size);
}

}  // extern "C"
#endif
