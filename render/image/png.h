// PNG files by libpng. Text chunks carry the provenance.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>

#include "render/image/image.h"

namespace render {

using TextChunks = std::map<std::string, std::string>;

/// Frames are written fast; pictures that are kept in a repository, small: the same pixels at many times the effort. Both leave out
/// alpha where all is opaque.
enum class PngEffort { fast, small };

/// Writes a part and renames it when whole. Throws RenderError with the path and the reason.
void write_png(const std::filesystem::path&, const Image&, const TextChunks& = {}, PngEffort = PngEffort::fast);

/// Any PNG as RGBA, 8 bits (16 bits are rounded, palettes and greys expanded, missing alpha is opaque). Refuses more than 16384
/// pixels a side, and more than `most_pixels` in all. Throws RenderError.
Image read_png(const std::filesystem::path&, TextChunks* text = nullptr, std::uint64_t most_pixels = std::uint64_t{1} << 28);

/// The text chunks that stand before the pixels, which are not read. Throws RenderError.
TextChunks read_png_text(const std::filesystem::path&);

/// How a file keeps its pixels.
struct PngFormat {
  int bit_depth = 8;  // of a channel, or of a palette's index
  bool palette = false;
  bool grey = false;
  bool alpha = false;  // as a channel or as transparent colours
};
PngFormat png_format(const std::filesystem::path&);

}  // namespace render
