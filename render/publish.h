// The first and the last step of every file written: it is ours alone while it grows, and appears under its name only when it is
// whole and kept by the disk.
#pragma once

#include <sys/types.h>

#include <cstdio>
#include <filesystem>
#include <string>

namespace render {

class PartFile {
 public:
  /// Makes FILE.NUMBER.part (TAG before the number, where a file grows in two), NUMBER that of this process. What lies there under
  /// that name and is no plain file (a link, a pipe, a device) was planted and is refused. Throws RenderError.
  explicit PartFile(std::filesystem::path file, const std::string& tag = "");
  /// Takes the part away unless it was published.
  ~PartFile();
  PartFile(const PartFile&) = delete;
  PartFile& operator=(const PartFile&) = delete;

  const std::filesystem::path& path() const { return part_; }
  /// For libraries that take a stream. Throws RenderError.
  std::FILE* stream() const;
  /// Writes the part through to the disk, renames it to FILE and writes the folder's entry through: after a kill or a power cut the
  /// name holds the old file or the new one, whole. Throws RenderError.
  void publish();

 private:
  std::filesystem::path file_, part_;
  pid_t owner_ = 0;  // a process forked meanwhile must not take it away
  bool published_ = false;
};

/// "a.mp4" of "a.mp4.123.part"; empty where the name is none of a part.
std::string whole_name(const std::string& part_name);

}  // namespace render
