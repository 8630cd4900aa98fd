// crashreel compare on pictures whose difference is known.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "render/image/png.h"
#include "tests/cli/program.h"
#include "tests/render/odd_png.h"

using namespace cli_tests;
using testing::HasSubstr;
using testing::StartsWith;
using Json = nlohmann::json;

namespace {

render::Image grey(int width, int height, std::uint8_t level) {
  render::Image image{width, height, std::vector<std::uint8_t>(static_cast<std::size_t>(4 * width * height), level)};
  for (std::size_t i = 3; i < image.rgba.size(); i += 4) image.rgba[i] = 255;
  return image;
}

}  // namespace

TEST(Compare, APictureIsTheSameAsItself) {
  const Folder folder;
  render::write_png((folder / "a.png").string(), grey(100, 100, 80));
  const Result result = run(folder, {"compare", "a.png", "a.png"});
  EXPECT_EQ(result.code, 0);
  EXPECT_THAT(result.out, StartsWith("same: 0 pixels differ, 0.0000 % by more than 2"));
}

TEST(Compare, ManyPixelsOffByALittleAreDifferent) {
  const Folder folder;
  render::Image b = grey(100, 100, 80);
  // 60 of 10,000 pixels, one more than the limit of 0.5 % allows, each by 3 in red
  for (std::size_t i = 0; i < 60; ++i) b.rgba[4 * i] = 83;
  render::write_png((folder / "a.png").string(), grey(100, 100, 80));
  render::write_png((folder / "b.png").string(), b);
  const Result result = run(folder, {"compare", "a.png", "b.png", "--json", "--diff", "d.png"});
  EXPECT_EQ(result.code, 1);
  const Json figures = Json::parse(result.out);
  EXPECT_FALSE(figures.at("same"));
  EXPECT_DOUBLE_EQ(figures.at("share_above_2"), 0.006);
  EXPECT_EQ(figures.at("pixels_above_32"), 0);
  EXPECT_EQ(figures.at("largest"), 3);
  // sqrt(60 * 9 / 40000)
  EXPECT_NEAR(figures.at("rms").get<double>(), 0.1161895, 1e-6);
  const render::Image d = render::read_png((folder / "d.png").string());
  EXPECT_EQ(d.rgba[0], 255) << "a differing pixel is marked";
  EXPECT_EQ(d.rgba[4 * 60], 26) << "an equal one is dimmed to a third";
}

TEST(Compare, PixelsOffByTwoAreTheSamePicture) {
  const Folder folder;
  render::Image b = grey(100, 100, 80);
  for (std::size_t i = 0; i < 60; ++i) b.rgba[4 * i] = 82;
  render::write_png((folder / "a.png").string(), grey(100, 100, 80));
  render::write_png((folder / "b.png").string(), b);
  EXPECT_EQ(run(folder, {"compare", "a.png", "b.png"}).code, 0);
}

TEST(Compare, DifferentSizesAreDifferentAndAMissingFileIsTheMachine) {
  const Folder folder;
  render::write_png((folder / "a.png").string(), grey(20, 20, 80));
  render::write_png((folder / "b.png").string(), grey(20, 21, 80));
  const Result sizes = run(folder, {"compare", "a.png", "b.png"});
  EXPECT_EQ(sizes.code, 1);
  EXPECT_EQ(sizes.err, "crashreel: a.png is 20x20, b.png is 20x21: pictures of different size are different\n");
  const Result told = run(folder, {"compare", "a.png", "b.png", "--json", "--diff", "d.png"});
  EXPECT_EQ(Json::parse(told.out).at("same"), false);
  EXPECT_THAT(told.err, HasSubstr("no difference picture is written"));
  EXPECT_FALSE(std::filesystem::exists(folder / "d.png"));
  const Result missing = run(folder, {"compare", "a.png", "none.png"});
  EXPECT_EQ(missing.code, 3);
  EXPECT_THAT(missing.err, HasSubstr("none.png"));
}

TEST(Compare, LimitsAndMasksAreSetByName) {
  const Folder folder;
  render::Image b = grey(100, 100, 80);
  for (std::size_t i = 0; i < 60; ++i) b.rgba[4 * i] = 83;
  render::write_png((folder / "a.png").string(), grey(100, 100, 80));
  render::write_png((folder / "b.png").string(), b);
  EXPECT_EQ(run(folder, {"compare", "a.png", "b.png", "--mask", "60x1+0+0"}).code, 0);
  EXPECT_EQ(run(folder, {"compare", "a.png", "b.png", "--mask", "59x1+0+0", "--limit", "share_above_2=0"}).code, 1);
  EXPECT_EQ(run(folder, {"compare", "a.png", "b.png", "--limit", "share_above_2=0.006", "--limit", "perceptual_worst=1"}).code, 0);
  const Result unknown = run(folder, {"compare", "a.png", "b.png", "--limit", "perceptual_wurst=1"});
  EXPECT_EQ(unknown.code, 2);
  EXPECT_THAT(unknown.err, HasSubstr("did you mean perceptual_worst?"));
  EXPECT_EQ(run(folder, {"compare", "a.png", "b.png", "--mask", "60x1"}).code, 2);
}

TEST(Compare, SaysWhatItCannotSee) {
  const Folder folder;
  // two pictures that differ in the lower eight bits only, one of them with alpha
  render::test::write_odd_png(folder / "a.png", 1, PNG_COLOR_TYPE_GRAY, 16, {{0x80, 0x10}});
  render::test::write_odd_png(folder / "b.png", 1, PNG_COLOR_TYPE_GRAY_ALPHA, 16, {{0x80, 0x11, 0xff, 0xff}});
  const Result result = run(folder, {"compare", "a.png", "b.png"});
  EXPECT_EQ(result.code, 0);
  EXPECT_EQ(result.err,
            "crashreel: a.png has 16 bits a channel; compared rounded to 8\n"
            "crashreel: b.png has 16 bits a channel; compared rounded to 8\n"
            "crashreel: a.png has no alpha; taken as opaque\n");
}
