#pragma once

#include <cstdint>

namespace scenes::cage {

struct Limits {
  unsigned long cpu_time = 10;     // [s]
  unsigned long memory = 1 << 30;  // [byte] of addresses
};

/// From now on this process computes, reads what it is handed, and answers: no file, no network, no other process, no signal to
/// one, no right of root. Returns the walls (Wall) that the kernel could raise; the others hold without them.
std::uint32_t raise_walls(const Limits&);

}  // namespace scenes::cage
