// A crew of processes that share what their parent has loaded, and take pieces of work until none is left.
#pragma once

#include <cstddef>
#include <functional>
#include <string>

namespace cli::inference {

/// `work(k)` for k = 0 .. count - 1, each in one of `jobs` processes, gives a line of text that ends in a newline; `take(k, line,
/// death)` gets it here, in whatever order the lines come. Where a process dies the line is empty and `death` says how; the others
/// go on. Throws MachineError when no process can be started, Interrupted when a signal asks to stop.
void run_crew(std::size_t count, int jobs, const std::function<std::string(std::size_t)>& work,
              const std::function<void(std::size_t, const std::string&, const std::string&)>& take);

}  // namespace cli::inference
