// Where the cameras stand that every scene has, and what a driver sees.
#include "cli/camera_presets.h"

#include <gtest/gtest.h>

#include "render/cameras.h"
#include "render/image/png.h"
#include "tests/cli/program.h"

namespace cli {
namespace {

using cli_tests::Folder;
using engine::Vec3;

std::string vehicle(const std::string& name, const std::string& model, const std::string& rest) {
  return "[[vehicle]]\nname = \"" + name + "\"\nmodel = \"" + model + "\"\n" + rest;
}

const std::string kWalker = "[[person]]\nname = \"ann\"\npose = \"walking_right\"\nposition = \"2 -2.4 m\"\n";

render::Camera preset(const Folder& folder, const std::string& name, const std::string& scene) {
  folder.write("a.toml", scene);
  return *preset_camera(name, scenes::load(folder / "a.toml"));
}

/// How much of a picture is nearly black.
double dark_share(const render::Image& image) {
  constexpr int kDark = 30;  // of 255: asphalt in the sun has 110, paint more
  std::size_t dark = 0;
  for (std::size_t i = 0; i < image.rgba.size(); i += 4)
    dark += image.rgba[i] < kDark && image.rgba[i + 1] < kDark && image.rgba[i + 2] < kDark;
  return static_cast<double>(dark) / static_cast<double>(image.rgba.size() / 4);
}

class DriversView : public testing::TestWithParam<const char*> {};

TEST_P(DriversView, ShowsTheRoadAndLittleOfTheCab) {
  const Folder folder;
  folder.write("a.toml",
               "[simulation]\nduration = \"0.01 s\"\n[road]\nkind = \"road\"\n[overlays]\ncaption = false\ndisclaimer = false\n" +
                   vehicle("v", GetParam(), "front = \"-12 -1.75 m\"\nspeed = \"40 km/h\"\n"));
  const cli_tests::Result drawn =
      run(folder, {"render", "a.toml", "--camera", "driver", "--at", "0", "--size", "160x90", "-o", "a.png"});
  ASSERT_EQ(drawn.code, 0) << drawn.err;
  // a pillar has up to a tenth of the picture
  EXPECT_LT(dark_share(render::read_png(folder / "a.png")), 0.12);
}
INSTANTIATE_TEST_SUITE_P(Library, DriversView, testing::Values("sedan", "small_car", "suv", "van", "bus", "truck"),
                         [](const auto& model) { return std::string(model.param); });

TEST(CameraPresets, TheDriverIsOfTheVehicleThatNearsThePersonOnFoot) {
  const Folder folder;
  const std::string parked = vehicle("parked", "sedan", "position = \"10 -2 m\"\n"),
                    away = vehicle("away", "sedan", "position = \"20 1.75 m\"\nspeed = \"90 km/h\"\n"),
                    comes = vehicle("comes", "van", "position = \"-12 -1.75 m\"\nspeed = \"30 km/h\"\n");
  EXPECT_EQ(preset(folder, "driver", parked + away + comes + kWalker).follow, "comes");
  EXPECT_EQ(preset(folder, "driver", parked + comes + away).follow, "away") << "nobody walks: the fastest";
  EXPECT_EQ(preset(folder, "driver", parked).follow, "parked");
}

TEST(CameraPresets, OnATwoWheelerTheRiderSees) {
  const Folder folder;
  const std::string text = vehicle("bike", "motorcycle", "position = \"3 1 m\"\nheading = \"30 deg\"\nspeed = \"50 km/h\"\n") +
                           "[[person]]\nname = \"rider\"\npose = \"motorcyclist\"\nrides = \"bike\"\n";
  const render::Camera camera = preset(folder, "driver", text);
  ASSERT_EQ(camera.follow, "rider");
  const scenes::Scene scene = scenes::load(folder / "a.toml");
  const auto& head = scene.model.bodies[static_cast<std::size_t>(scene.model.persons.front().head)];
  const Vec3 ahead(std::cos(M_PI / 6), std::sin(M_PI / 6), 0), eye = head.X_WB * camera.position;
  const double half_length = std::get<engine::HyperEllipsoid>(head.shape).semi_axes.maxCoeff();
  EXPECT_GT((eye - head.X_WB.p).dot(ahead), half_length) << "outside of the head, whatever the pose";
  const Vec3 gaze = (head.X_WB * camera.target - eye).normalized();
  EXPECT_NEAR(gaze.dot(ahead), 1, 0.01) << "along the way, a little down";
}

TEST(CameraPresets, FollowStandsOnTheSideOfThePersonAtTheMeeting) {
  const Folder folder;
  const auto side_of = [&folder](const std::string& person) {
    const render::Camera camera =
        preset(folder, "follow", vehicle("car", "sedan", "front = \"-10 0 m\"\nspeed = \"36 km/h\"\n") + person);
    EXPECT_EQ(camera.follow, "ann");
    EXPECT_GT(std::abs(camera.position.y()), std::abs(camera.position.x())) << "more beside than behind: the car is behind";
    return camera.position.y() > 0 ? 1 : -1;
  };
  const auto ann = [](const std::string& rest) { return "[[person]]\nname = \"ann\"\npose = \"walking_right\"\n" + rest; };
  const std::string rider = "[[person]]\nname = \"ann\"\npose = \"cyclist\"\nrides = \"bike\"\n";
  EXPECT_EQ(side_of(vehicle("bike", "bicycle", "position = \"2 0.8 m\"\n") + rider), 1) << "a cyclist is followed too";
  EXPECT_EQ(side_of(ann("position = \"2 0.5 m\"\n")), 1);
  EXPECT_EQ(side_of(ann("position = \"2 -0.5 m\"\n")), -1);
  EXPECT_EQ(side_of(ann("position = \"2 -0.5 m\"\n") + vehicle("parked", "van", "position = \"-1 -3 m\"\n")), 1)
      << "a van stands on her side";
  // she walks across: when the car is there she has come to the other side
  EXPECT_EQ(side_of(ann("position = \"2 -0.7 m\"\nheading = \"90 deg\"\nspeed = \"1.5 m/s\"\n")), 1);
}

}  // namespace
}  // namespace cli
