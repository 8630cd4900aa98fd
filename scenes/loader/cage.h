// Foreign meshes are read by a process of its own that can do nothing but compute: scenes/cage. This is the
// parent's side, which starts it, hands it the files it may see, and takes what it says.
#pragma once

#include <filesystem>
#include <string>

namespace scenes {

struct CageLimits {
  int cpu_time = 10;                           // [s] a vehicle of a million triangles takes about three
  unsigned long memory = 2ul << 30;            // [byte] a detailed vehicle needs some hundred MB in the importer
  std::size_t largest = std::size_t{1} << 29;  // [byte] of an answer
  int patience = 300;                          // [s] of the clock: a worker that computes is ended by its own time before
};

struct CageAnswer {
  std::string bytes;    // what was read
  std::string problem;  // empty: it was read
  std::string warning;  // which walls this kernel could not raise
};

/// Has a mesh read. The worker sees that file and, below `root`, what belongs to a mesh. Never throws.
CageAnswer ask_cage(const std::filesystem::path& file, const std::filesystem::path& root, const CageLimits& = {});

}  // namespace scenes
