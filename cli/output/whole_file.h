// A text file that appears under its name only when it is whole.
#pragma once

#include <cstdio>
#include <filesystem>
#include <string_view>

#include "render/publish.h"

namespace cli {

/// Throws MachineError when `folder` is missing or cannot be written; creates it first where only its last part is missing.
void make_writable_folder(const std::filesystem::path& folder);
/// Throws UsageError when the file is there and may not be replaced.
void refuse_existing(const std::filesystem::path& file, bool overwrite);

class WholeFile {
 public:
  /// Makes its part. Throws RenderError.
  explicit WholeFile(std::filesystem::path file);
  ~WholeFile();
  WholeFile(const WholeFile&) = delete;
  WholeFile& operator=(const WholeFile&) = delete;

  void write(std::string_view text);
  /// Writes out what is buffered; throws MachineError with the reason (disk full).
  void close();
  /// Gives the file its name. After close. Throws RenderError.
  void publish();

 private:
  [[noreturn]] void fail(const char* doing) const;

  std::filesystem::path file_;
  render::PartFile part_;
  std::FILE* stream_ = nullptr;
};

/// A file of this text and nothing else, whole or not at all.
void write_whole(const std::filesystem::path&, const std::string& text);

}  // namespace cli
