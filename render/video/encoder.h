// H.264 in MP4 by libav*. The bytes depend on the encoder's thread count, so that is pinned.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "render/image/image.h"

namespace render {

/// RGBA to planar YUV 4:2:0, BT.709, limited range. `out` holds width * height * 3 / 2 bytes: Y, U, V.
void rgba_to_i420(const Image&, std::uint8_t* out);

class VideoEncoder {
 public:
  /// Sizes must be even (RenderError names the next even one). Writes fragments to OUT.part: a kill leaves what was encoded
  /// readable.
  VideoEncoder(const std::filesystem::path& output, int width, int height, double fps,
               const std::map<std::string, std::string>& metadata);
  ~VideoEncoder();
  VideoEncoder(const VideoEncoder&) = delete;
  VideoEncoder& operator=(const VideoEncoder&) = delete;

  void append(const std::uint8_t* i420);
  /// Flushes, rewrites the file with its index in front, renames it to its final name.
  void finish();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// What a finished film says of itself. Throws RenderError when it cannot be read.
std::map<std::string, std::string> read_film_metadata(const std::filesystem::path&);

}  // namespace render
