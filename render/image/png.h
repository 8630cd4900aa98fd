// PNG files by libpng. Text chunks carry the provenance.
#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "render/image/image.h"

namespace render {

using TextChunks = std::map<std::string, std::string>;

/// Writes PATH.part and renames it when whole. Throws RenderError with the path and the reason.
void write_png(const std::filesystem::path&, const Image&, const TextChunks& = {});

/// Any PNG as RGBA, 8 bits (16 bits are rounded, palettes expanded). Refuses more than 16384 pixels a side. Throws RenderError.
Image read_png(const std::filesystem::path&, TextChunks* text = nullptr);

}  // namespace render
