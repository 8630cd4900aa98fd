#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>

#include "render/error.h"
#include "render/image/png.h"

namespace render {
namespace {

namespace fs = std::filesystem;

fs::path scratch(const char* name) {
  return fs::path(testing::TempDir()) / name;
}

Image pattern() {
  Image image{7, 5, {}};
  for (int i = 0; i < 4 * 7 * 5; ++i) image.rgba.push_back(static_cast<std::uint8_t>((i * 37 + i / 4) & 255));
  return image;
}

TEST(Png, ComesBackByteForByteWithItsText) {
  const fs::path path = scratch("round_trip.png");
  const TextChunks text{{"Title", "Sedan, 40 km/h"}, {"Comment", "µ = 0.72, two\nlines"}};
  write_png(path, pattern(), text);
  TextChunks back;
  const Image image = read_png(path, &back);
  EXPECT_EQ(image.width, 7);
  EXPECT_EQ(image.height, 5);
  EXPECT_EQ(image.rgba, pattern().rgba);
  for (const auto& [key, value] : text) EXPECT_EQ(back[key], value);
  EXPECT_FALSE(fs::exists(path.string() + ".part"));
}

TEST(Png, CutShortIsRefusedWithItsPath) {
  const fs::path path = scratch("cut.png");
  write_png(path, pattern());
  fs::resize_file(path, fs::file_size(path) / 2);
  try {
    read_png(path);
    FAIL() << "half a file was read";
  } catch (const RenderError& e) {
    EXPECT_THAT(e.what(), testing::HasSubstr("cut.png"));
  }
}

TEST(Png, OfAbsurdSizeIsRefused) {
  const fs::path path = scratch("huge.png");
  write_png(path, pattern());
  // width 2^30 in the header; its checksum is then wrong too, and either reason will do
  std::fstream file(path, std::ios::in | std::ios::out | std::ios::binary);
  file.seekp(16);
  file.put('\x40');
  file.close();
  EXPECT_THROW(read_png(path), RenderError);
}

TEST(Png, ThatIsNotThereIsAnError) {
  EXPECT_THROW(read_png(scratch("none.png")), RenderError);
}

}  // namespace
}  // namespace render
