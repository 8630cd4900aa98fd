// PNGs as other programs write them: 16 bits a channel, palettes, greys.
#pragma once

#include <png.h>

#include <cstdio>
#include <filesystem>
#include <vector>

namespace render::test {

/// Rows as they go into the file (16-bit values big-endian). A palette gets its colours and, where given, their transparency.
inline void write_odd_png(const std::filesystem::path& path, int width, int colour_type, int bit_depth,
                          const std::vector<std::vector<unsigned char>>& rows, const std::vector<png_color>& palette = {},
                          const std::vector<png_byte>& palette_alpha = {}) {
  std::FILE* file = std::fopen(path.c_str(), "wb");
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
  png_infop info = png_create_info_struct(png);
  png_init_io(png, file);
  png_set_IHDR(png, info, static_cast<png_uint_32>(width), static_cast<png_uint_32>(rows.size()), bit_depth, colour_type,
               PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  if (!palette.empty()) png_set_PLTE(png, info, palette.data(), static_cast<int>(palette.size()));
  if (!palette_alpha.empty()) png_set_tRNS(png, info, palette_alpha.data(), static_cast<int>(palette_alpha.size()), nullptr);
  png_write_info(png, info);
  for (const auto& row : rows) png_write_row(png, row.data());
  png_write_end(png, info);
  png_destroy_write_struct(&png, &info);
  std::fclose(file);
}

}  // namespace render::test
