#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>

#include "odd_png.h"
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

TEST(Png, Of16BitsIsRoundedAndSaysSo) {
  const fs::path path = scratch("deep.png");
  // 0x80ff is 33023 of 65535: 128.5 of 255, and 0x0100 is 0.996
  test::write_odd_png(path, 2, PNG_COLOR_TYPE_RGB, 16, {{0x80, 0xff, 0, 0, 0xff, 0xff, 0x01, 0x00, 0x80, 0x00, 0x7f, 0x00}});
  const Image image = read_png(path);
  EXPECT_THAT(image.rgba, testing::ElementsAre(128, 0, 255, 255, 1, 128, 127, 255));
  EXPECT_EQ(png_format(path).bit_depth, 16);
  EXPECT_FALSE(png_format(path).alpha);
}

TEST(Png, OfAPaletteShowsItsColours) {
  const fs::path path = scratch("palette.png");
  test::write_odd_png(path, 3, PNG_COLOR_TYPE_PALETTE, 2, {{0b00011000}}, {{10, 20, 30}, {40, 50, 60}, {70, 80, 90}}, {255, 128});
  const Image image = read_png(path);
  EXPECT_THAT(image.rgba, testing::ElementsAre(10, 20, 30, 255, 40, 50, 60, 128, 70, 80, 90, 255));
  EXPECT_TRUE(png_format(path).palette);
  EXPECT_TRUE(png_format(path).alpha);
}

TEST(Png, OfGreysWithFewBitsBecomesColours) {
  const fs::path path = scratch("grey.png");
  test::write_odd_png(path, 4, PNG_COLOR_TYPE_GRAY, 1, {{0b01100000}});
  EXPECT_THAT(read_png(path).rgba, testing::ElementsAre(0, 0, 0, 255, 255, 255, 255, 255, 255, 255, 255, 255, 0, 0, 0, 255));
  EXPECT_TRUE(png_format(path).grey);
}

TEST(Png, KeptSmallIsTheSamePicture) {
  Image opaque = pattern();
  for (std::size_t i = 3; i < opaque.rgba.size(); i += 4) opaque.rgba[i] = 255;
  for (const Image& image : {pattern(), opaque}) {
    const fs::path path = scratch("small.png");
    write_png(path, image, {}, PngEffort::small);
    EXPECT_EQ(read_png(path).rgba, image.rgba);
  }
  EXPECT_FALSE(png_format(scratch("small.png")).alpha) << "alpha that is opaque everywhere is left out";
}

}  // namespace
}  // namespace render
