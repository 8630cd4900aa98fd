#include "render/image/png.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <libdeflate.h>
#include <png.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>
#include <vector>

#include "render/error.h"
#include "render/publish.h"

namespace render {
namespace {

constexpr png_uint_32 kLargest = 16384;  // [pixels] a side
constexpr png_uint_32 kMostChunks = 64;  // texts and the like; ours have ten

struct FileCloser {
  void operator()(std::FILE* f) const { std::fclose(f); }
};
using FilePtr = std::unique_ptr<std::FILE, FileCloser>;

/// libpng reports by a callback that must not return: the message leaves as an exception, which its C code lets pass (built with
/// unwind tables).
[[noreturn]] void fail(png_structp png, png_const_charp message) {
  // what libpng calls so is a full disk, a quota, a drive that went away
  const std::string why = std::strcmp(message, "Write Error") == 0 && errno != 0 ? std::strerror(errno) : message;
  throw RenderError(std::string(static_cast<const char*>(png_get_error_ptr(png))) + ": " + why);
}
void ignore(png_structp, png_const_charp) {}

/// Another kind of picture is told by its name, not by what libpng stumbles over in it.
void refuse_other_kinds(std::FILE* file, png_structp png) {
  unsigned char head[8] = {};
  const std::size_t size = std::fread(head, 1, sizeof head, file);
  std::rewind(file);
  if (size == sizeof head && png_sig_cmp(head, 0, sizeof head) == 0) return;
  if (head[0] == 0xff && head[1] == 0xd8) png_error(png, "it is a JPEG picture, only PNG is read; convert it");
  png_error(png, size == 0 ? "it is empty" : "it is no PNG picture; convert it to PNG");
}

/// libpng makes room for what a chunk announces before it looks whether it is there.
void refuse_endless_chunks(std::FILE* file, png_structp png) {
  std::fseek(file, 0, SEEK_END);
  const long size = std::ftell(file);
  unsigned char head[4];
  for (long at = 8; std::fseek(file, at, SEEK_SET) == 0 && std::fread(head, 1, sizeof head, file) == sizeof head;) {
    const auto length = static_cast<long>(png_get_uint_32(head));
    if (length > size - at) png_error(png, "a chunk is longer than the file");
    at += 12 + length;  // length, name and checksum around it
  }
  std::rewind(file);
}

/// A few bytes can announce a gigabyte of pixels. Deflate makes at most 1032 bytes of one (zlib's technical notes).
void refuse_what_the_file_cannot_hold(png_structp png, png_infop info, const std::filesystem::path& path) {
  constexpr std::uintmax_t kMost = 1032;
  std::error_code unknown;
  const std::uintmax_t size = std::filesystem::file_size(path, unknown);
  const std::uintmax_t rows = std::uintmax_t{png_get_rowbytes(png, info)} * png_get_image_height(png, info);
  if (!unknown && rows / kMost > size) png_error(png, "the file is too short for a picture of its size");
}

/// A PNG open for reading. Only plain files: a pipe planted among the frames would hold the run for ever.
class PngReader {
 public:
  explicit PngReader(const std::filesystem::path& path) : what_("cannot read " + path.string()), file_(open_plain(path)) {
    png_ = png_create_read_struct(PNG_LIBPNG_VER_STRING, const_cast<char*>(what_.c_str()), fail, ignore);
    info_ = png_create_info_struct(png_);
    try {
      refuse_other_kinds(file_.get(), png_);
      refuse_endless_chunks(file_.get(), png_);
    } catch (...) {
      png_destroy_read_struct(&png_, &info_, nullptr);
      throw;
    }
    png_init_io(png_, file_.get());
    png_set_chunk_cache_max(png_, kMostChunks);
    png_set_user_limits(png_, kLargest, kLargest);
    png_set_chunk_malloc_max(png_, 8u << 20);
  }
  ~PngReader() { png_destroy_read_struct(&png_, &info_, nullptr); }
  PngReader(const PngReader&) = delete;
  PngReader& operator=(const PngReader&) = delete;

  png_structp png() const { return png_; }
  png_infop info() const { return info_; }
  /// Of the chunks read so far.
  TextChunks text() const {
    TextChunks out;
    png_textp chunks = nullptr;
    int count = 0;
    png_get_text(png_, info_, &chunks, &count);
    for (int i = 0; i < count; ++i) out[chunks[i].key] = std::string(chunks[i].text, chunks[i].text_length);
    return out;
  }

 private:
  FilePtr open_plain(const std::filesystem::path& path) const {
    const int handle = open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
    if (handle < 0) throw RenderError(what_ + ": " + std::strerror(errno));
    FilePtr file(fdopen(handle, "rb"));
    struct stat found {};
    if (!file) close(handle);
    if (!file || fstat(handle, &found) != 0) throw RenderError(what_ + ": " + std::strerror(errno));
    if (!S_ISREG(found.st_mode)) throw RenderError(what_ + ": it is no plain file");
    return file;
  }

  std::string what_;
  FilePtr file_;
  png_structp png_ = nullptr;
  png_infop info_ = nullptr;
};

bool is_opaque(const Image& image) {
  unsigned all = 255;
  for (std::size_t i = 3; i < image.rgba.size(); i += 4) all &= image.rgba[i];
  return all == 255;
}

/// Rows with the filter Sub: each byte less its left neighbour's of the same channel.
template <std::size_t kChannels>
std::vector<std::uint8_t> left_differences(const Image& image) {
  const std::size_t width = static_cast<std::size_t>(image.width), height = static_cast<std::size_t>(image.height);
  std::vector<std::uint8_t> out((1 + kChannels * width) * height);
  std::uint8_t* to = out.data();
  const std::uint8_t* from = image.rgba.data();
  for (std::size_t y = 0; y < height; ++y) {
    *to++ = 1;
    for (std::size_t x = 0; x < width; ++x, from += 4, to += kChannels)
      for (std::size_t c = 0; c < kChannels; ++c) to[c] = static_cast<std::uint8_t>(x == 0 ? from[c] : from[c] - *(from + c - 4));
  }
  return out;
}

/// libpng writes the chunks, libdeflate what is in them: half of what zlib's fastest level takes.
void write_pixels_fast(png_structp png, const Image& image, bool opaque) {
  const std::vector<std::uint8_t> rows = opaque ? left_differences<3>(image) : left_differences<4>(image);
  const std::unique_ptr<libdeflate_compressor, decltype(&libdeflate_free_compressor)> compressor(libdeflate_alloc_compressor(1),
                                                                                                 libdeflate_free_compressor);
  if (!compressor) png_error(png, "no memory to compress it");
  const std::size_t most = libdeflate_zlib_compress_bound(compressor.get(), rows.size());  // mostly a quarter is used
  const auto stream = std::make_unique_for_overwrite<std::uint8_t[]>(most);
  const std::size_t size = libdeflate_zlib_compress(compressor.get(), rows.data(), rows.size(), stream.get(), most);
  png_write_chunk(png, reinterpret_cast<png_const_bytep>("IDAT"), stream.get(), size);
  png_write_chunk(png, reinterpret_cast<png_const_bytep>("IEND"), nullptr, 0);
}

void write_pixels_small(png_structp png, const Image& image, bool opaque) {
  if (opaque) png_set_filler(png, 0, PNG_FILLER_AFTER);
  const std::size_t row = 4 * static_cast<std::size_t>(image.width);
  for (int y = 0; y < image.height; ++y)
    png_write_row(png, const_cast<png_bytep>(image.rgba.data() + row * static_cast<std::size_t>(y)));
  png_write_end(png, nullptr);
}

}  // namespace

void write_png(const std::filesystem::path& path, const Image& image, const TextChunks& text, PngEffort effort) {
  const std::string what = "cannot write " + path.string();
  PartFile part(path);
  FilePtr file(part.stream());
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, const_cast<char*>(what.c_str()), fail, ignore);
  png_infop info = png_create_info_struct(png);
  try {
    png_init_io(png, file.get());
    const bool opaque = is_opaque(image);
    png_set_compression_level(png, 9);
    png_set_filter(png, 0, PNG_ALL_FILTERS);
    png_set_IHDR(png, info, static_cast<png_uint_32>(image.width), static_cast<png_uint_32>(image.height), 8,
                 opaque ? PNG_COLOR_TYPE_RGB : PNG_COLOR_TYPE_RGB_ALPHA, PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT,
                 PNG_FILTER_TYPE_DEFAULT);
    png_set_sRGB(png, info, PNG_sRGB_INTENT_PERCEPTUAL);
    std::vector<png_text> chunks;
    for (const auto& [key, value] : text) {
      png_text chunk{};
      chunk.compression = PNG_TEXT_COMPRESSION_NONE;
      chunk.key = const_cast<char*>(key.c_str());
      chunk.text = const_cast<char*>(value.c_str());
      chunk.text_length = value.size();
      chunks.push_back(chunk);
    }
    if (!chunks.empty()) png_set_text(png, info, chunks.data(), static_cast<int>(chunks.size()));
    png_write_info(png, info);
    (effort == PngEffort::small ? write_pixels_small : write_pixels_fast)(png, image, opaque);
    png_destroy_write_struct(&png, &info);
    if (std::fclose(file.release()) != 0) throw RenderError(what + ": " + std::strerror(errno));
    part.publish();
  } catch (...) {
    if (png) png_destroy_write_struct(&png, &info);
    throw;
  }
}

Image read_png(const std::filesystem::path& path, TextChunks* text, std::uint64_t most_pixels) {
  PngReader reader(path);
  png_structp png = reader.png();
  png_infop info = reader.info();
  png_read_info(png, info);
  if (std::uint64_t{png_get_image_width(png, info)} * png_get_image_height(png, info) > most_pixels)
    png_error(png, fmt::format("it has more than {} million pixels", most_pixels >> 20).c_str());
  refuse_what_the_file_cannot_hold(png, info, path);
  png_set_expand(png);
  png_set_scale_16(png);
  png_set_gray_to_rgb(png);
  png_set_add_alpha(png, 0xff, PNG_FILLER_AFTER);
  png_set_interlace_handling(png);
  png_read_update_info(png, info);
  Image image;
  image.width = static_cast<int>(png_get_image_width(png, info));
  image.height = static_cast<int>(png_get_image_height(png, info));
  const std::size_t row = png_get_rowbytes(png, info);
  image.rgba.resize(row * static_cast<std::size_t>(image.height));
  std::vector<png_bytep> rows;
  for (std::size_t y = 0; y < static_cast<std::size_t>(image.height); ++y) rows.push_back(image.rgba.data() + row * y);
  png_read_image(png, rows.data());
  png_read_end(png, info);
  if (text) *text = reader.text();
  return image;
}

TextChunks read_png_text(const std::filesystem::path& path) {
  PngReader reader(path);
  png_read_info(reader.png(), reader.info());
  return reader.text();
}

PngFormat png_format(const std::filesystem::path& path) {
  PngReader reader(path);
  png_structp png = reader.png();
  png_infop info = reader.info();
  png_read_info(png, info);
  const int colours = png_get_color_type(png, info);
  PngFormat format;
  format.bit_depth = png_get_bit_depth(png, info);
  format.palette = colours == PNG_COLOR_TYPE_PALETTE;
  format.grey = (colours & PNG_COLOR_MASK_COLOR) == 0;
  format.alpha = (colours & PNG_COLOR_MASK_ALPHA) != 0 || png_get_valid(png, info, PNG_INFO_tRNS) != 0;
  return format;
}

}  // namespace render
