// Two runs must not write the same output: their temporary files would be one file.
#pragma once

#include <filesystem>

namespace cli {

class OutputLock {
 public:
  /// Takes OUTPUT.lock; the system lets go of it when the process ends, however it ends. Throws MachineError when another run has
  /// it.
  explicit OutputLock(const std::filesystem::path& output);
  ~OutputLock();
  OutputLock(const OutputLock&) = delete;
  OutputLock& operator=(const OutputLock&) = delete;

 private:
  std::filesystem::path file_;
  int handle_ = -1;
};

}  // namespace cli
