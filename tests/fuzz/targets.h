// What reads text and bytes from strangers, each as one function over any bytes. The tests replay the corpus; with
// CRASHREEL_FUZZ_TARGET set to a name of the table, targets.cpp is a libFuzzer target.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

namespace fuzz {

/// Each ends the process when a promise is broken: a number that is not finite gets through, an exception of a foreign kind.
void scene(std::string_view);
void quantity(std::string_view);
void frames(std::string_view);
void png(std::string_view);
void mesh(std::string_view);
void cage(std::string_view);

struct Target {
  const char* name;
  void (*run)(std::string_view);
};
std::span<const Target> targets();

}  // namespace fuzz
