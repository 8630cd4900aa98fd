// H.264 in MP4, or lossless FFV1 in Matroska, by libav*. The bytes depend on the encoder's thread count, so that is pinned.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "render/image/image.h"
#include "render/video/story.h"

namespace render {

/// RGBA to planar YUV 4:2:0, BT.709, limited range. `out` holds width * height * 3 / 2 bytes: Y, U, V.
void rgba_to_i420(const Image&, std::uint8_t* out);

class VideoEncoder {
 public:
  /// OUT.mkv is lossless, anything else an MP4. An MP4's sizes must be even (RenderError names the next even one). Writes fragments
  /// to a part: a kill leaves what was encoded readable.
  VideoEncoder(const std::filesystem::path& output, int width, int height, double fps,
               const std::map<std::string, std::string>& metadata, const Story& story = {});
  ~VideoEncoder();
  VideoEncoder(const VideoEncoder&) = delete;
  VideoEncoder& operator=(const VideoEncoder&) = delete;

  /// Planar I420 for an MP4, RGBA for a lossless film.
  void append(const std::uint8_t* picture);
  /// Flushes, rewrites the file with its index in front, renames it to its final name.
  void finish();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// What a finished film says of itself. Throws RenderError when it cannot be read.
std::map<std::string, std::string> read_film_metadata(const std::filesystem::path&);

}  // namespace render
