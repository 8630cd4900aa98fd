// What parent and caged worker say to each other over one socket. The worker opens nothing itself: it asks, and gets a file that is
// open already, or none.
#pragma once

#include <cstdint>

namespace scenes::cage {

constexpr int kSocket = 3;  // the worker's only descriptor beside /dev/null

/// Before each text of the worker.
struct Header {
  enum Kind : std::uint32_t { open_file = 1, result = 2 };
  std::uint32_t kind = 0;
  std::uint32_t walls = 0;  // of a result: those that stand
  std::uint64_t length = 0;
};

/// The parent's answer to open_file: one byte, with the open file beside it or without.
constexpr char kHere = 'Y', kRefused = 'N';

/// Exit code of a worker that was refused memory.
constexpr int kNoMemory = 5;

/// Walls that a kernel may lack.
enum Wall : std::uint32_t { landlock = 1, seccomp = 2 };

}  // namespace scenes::cage
