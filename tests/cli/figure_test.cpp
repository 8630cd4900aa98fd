// The figure command: which files a run gives, that they are whole, and that drawings keep their scale.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <regex>

#include "tests/cli/program.h"

using namespace cli_tests;
using testing::HasSubstr;

namespace {

const std::string kFlagship = std::string(CRASHREEL_SOURCE_DIR) + "/scenes/cases/sedan_pedestrian_40kmh.toml";

TEST(Figure, OfAStruckPersonIsSixFiguresEachWhole) {
  const Folder folder;
  const Result result = run(folder, {"figure", kFlagship, "-o", "fig", "--size", "480x270", "--quality", "draft", "--quiet"});
  ASSERT_EQ(result.code, 0) << result.err;
  for (const std::string name : {"site_diagram", "contact_map", "time_histories", "vehicle_histories"}) {
    const std::string pdf = contents(folder / ("fig/" + name + ".pdf")), svg = contents(folder / ("fig/" + name + ".svg"));
    EXPECT_EQ(pdf.substr(0, 5), "%PDF-") << name;
    EXPECT_THAT(pdf.substr(pdf.size() - 8), HasSubstr("%%EOF")) << name;
    EXPECT_THAT(svg, HasSubstr("</svg>")) << name;
    // A4, landscape, in points
    EXPECT_TRUE(std::regex_search(svg.substr(0, 400), std::regex("viewBox=\"0 0 841\\.8[0-9]* 595\\.2"))) << svg.substr(0, 300);
  }
  for (const std::string name : {"stroboscopic", "contact_sheet"})
    EXPECT_THAT(contents(folder / ("fig/" + name + ".png")), HasSubstr("scene_sha256")) << name << " carries its provenance";
  for (const auto& entry : std::filesystem::directory_iterator(folder / "fig")) EXPECT_NE(entry.path().extension(), ".part");
}

TEST(Figure, OfAScenePersonsAreNotInLeavesOutWhatItCannotShow) {
  const Folder folder;
  folder.write("ball.toml", kBall);
  const Result result = run(folder, {"figure", "ball.toml", "-o", "fig", "--size", "160x90", "--quality", "draft"});
  ASSERT_EQ(result.code, 0) << result.err;
  EXPECT_FALSE(std::filesystem::exists(folder / "fig/contact_map.pdf"));
  EXPECT_THAT(result.err, HasSubstr("contact_map: the run has nothing to show there"));
  EXPECT_TRUE(std::filesystem::exists(folder / "fig/time_histories.pdf"));
  EXPECT_THAT(contents(folder / "fig/site_diagram.svg"), HasSubstr("stroke-dasharray")) << "where the ball began, and its way";
}

TEST(Figure, OfSeveralStruckHasAContactMapAndASheetEach) {
  const Folder folder;
  const auto person = [](const std::string& name, const std::string& y) {
    return "[[person]]\nname = \"" + name + "\"\nstature = \"175 cm\"\nmass = \"75 kg\"\nposition = \"0.6 " + y + " m\"\n";
  };
  folder.write("two.toml",
               "[simulation]\nduration = \"0.1 s\"\n[[vehicle]]\nname = \"car\"\nmodel = \"sedan\"\nfront = \"0 0 m\"\nspeed = "
               "\"40 km/h\"\n" +
                   person("bystander", "9") + person("left", "0.5") + person("right", "-0.5"));
  const std::vector<std::string> draw = {"figure", "two.toml", "-o", "fig", "--size", "160x90", "--quality", "draft", "--quiet"};
  ASSERT_EQ(run(folder, draw).code, 0);
  const auto map = [&folder](const std::string& after) { return contents(folder / ("fig/contact_map" + after + ".pdf")); };
  EXPECT_NE(map(""), map("_right"));
  EXPECT_THAT(names_in(folder / "fig"),
              testing::IsSupersetOf({"contact_map.pdf", "contact_map_right.svg", "contact_sheet.png", "contact_sheet_right.png"}));
  EXPECT_EQ(map("_left"), "") << "the first who was struck has the plain names";
  EXPECT_EQ(map("_bystander"), "") << "nobody struck the third";
  EXPECT_EQ(run(folder, draw).code, 2) << "they are there";
}

/// By the letters drawn: glyphs of an SVG by cairo are <use> elements.
TEST(Figure, ASiteDiagramNamesItsVehiclesWhereTheyStoodAndStand) {
  const auto letters_of = [](const std::string& name, const std::string& speed) {
    const Folder folder;
    folder.write("one.toml", "[simulation]\nduration = \"1 s\"\n[[vehicle]]\nname = \"" + name +
                                 "\"\nmodel = \"sedan\"\nspeed = \"" + speed + "\"\n");
    const Result result = run(folder, {"figure", "one.toml", "-o", "fig", "--size", "160x90", "--quality", "draft", "--quiet"});
    EXPECT_EQ(result.code, 0) << result.err;
    const std::string svg = contents(folder / "fig/site_diagram.svg");
    const std::regex use("<use ");
    return std::distance(std::sregex_iterator(svg.begin(), svg.end(), use), std::sregex_iterator());
  };
  EXPECT_EQ(letters_of("abcde", "36 km/h") - letters_of("a", "36 km/h"), 2 * 4);
  EXPECT_EQ(letters_of("abcde", "0 km/h") - letters_of("a", "0 km/h"), 4) << "once where it stays";
}

TEST(Figure, RefusesToReplaceUnlessAsked) {
  const Folder folder;
  folder.write("ball.toml", kBall);
  std::filesystem::create_directory(folder / "fig");
  folder.write("fig/site_diagram.svg", "mine");
  const Result result = run(folder, {"figure", "ball.toml", "-o", "fig"});
  EXPECT_EQ(result.code, 2);
  EXPECT_THAT(result.err, HasSubstr("--overwrite"));
  EXPECT_EQ(contents(folder / "fig/site_diagram.svg"), "mine");
}

}  // namespace
