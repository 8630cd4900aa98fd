// Work in a process of its own: libraries that draw end their process where memory fails, and ours must say so.
#pragma once

#include <functional>
#include <string>
#include <vector>

namespace cli {

/// What `work` returns. Throws MachineError with what it threw, or when its process died.
std::vector<std::string> apart(const std::string& what, const std::function<std::vector<std::string>()>& work);

}  // namespace cli
