// Which build of the program runs.
#pragma once

#include <string>

namespace cli {

/// The linker's hash of the running program, 40 hexadecimal digits: a new build may give new answers. Read from memory: no file is
/// hashed, which took a short run half of its time, and a program replaced meanwhile changes nothing.
/// Throws std::logic_error where the program was linked without one.
std::string build_id();

}  // namespace cli
