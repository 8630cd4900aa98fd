// Two runs must not write the same output: one would publish what the other still writes.
#pragma once

#include <filesystem>
#include <functional>
#include <string>

namespace cli {

class OutputLock {
 public:
  /// Whether a file of this name, in the folder of the output, is one that the run may write.
  using Covers = std::function<bool(const std::string& name)>;

  /// Takes OUTPUT.lock; the system lets go of it when the process ends, however it ends. Then, and at its own end, it takes away
  /// the parts of files that killed runs and processes left: nobody else writes them now. Throws MachineError when another run has
  /// it. Left out, `covers` is the output alone.
  explicit OutputLock(const std::filesystem::path& output, Covers covers = {});
  ~OutputLock();
  OutputLock(const OutputLock&) = delete;
  OutputLock& operator=(const OutputLock&) = delete;

 private:
  void take();
  void clear() const;

  std::filesystem::path output_, file_;
  Covers covers_;
  int handle_ = -1;
};

/// Takes away the parts of files in a folder whose names `covers` knows. The caller holds the lock of their run.
void clear_parts(const std::filesystem::path& folder, const OutputLock::Covers& covers);

}  // namespace cli
