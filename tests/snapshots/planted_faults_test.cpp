// The default limits against what they are for: faults planted one at a time into pictures of our own renderer are seen, what
// another processor does to a picture is not.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "engine/simulate.h"
#include "render/arrange.h"
#include "render/image/compare.h"
#include "render/renderer.h"
#include "scenes/scene.h"

namespace {

const std::filesystem::path kSource = CRASHREEL_SOURCE_DIR;

struct Size {
  int width, height;
};
constexpr Size kLarge{960, 540};  // 518,400 pixels
constexpr Size kSmall{320, 180};  // the default of snapshots

/// A moment of a scene, ready to be drawn right or with a fault in it.
struct PlantedPicture {
  scenes::Scene scene;
  engine::Recording run;
  render::Moment moment;

  PlantedPicture(const char* file, double time, const char* camera)
      : scene(scenes::load(kSource / "scenes" / file, {"simulation.duration=0.15 s"})),
        run(engine::simulate(scene.model)),
        moment{time, camera, 1} {
    scene.stage.provenance.clear();
  }
  render::DrawList list(Size size) const {
    return render::arrange(scene.stage, run, moment, static_cast<double>(size.width) / size.height);
  }
};

/// The flagship at the moment the car meets the leg: contact markers, arrows, caption, a person, a car.
const PlantedPicture& contact() {
  static const PlantedPicture shown("cases/sedan_pedestrian_40kmh.toml", 0.12, "follow");
  return shown;
}

render::Image draw(const render::DrawList& list, Size size) {
  render::Renderer renderer(size.width, size.height, render::Quality::standard);
  render::Image image;
  renderer.draw(list, image);
  return image;
}

/// The planted fault must be seen; if it is not, the figures tell how near it came.
void expect_seen(const render::DrawList& right, const render::DrawList& wrong, Size size) {
  const render::Difference found = render::difference_of(draw(right, size), draw(wrong, size));
  std::string figures;
  for (const render::Measure& m : render::measures()) figures += std::string(m.name) + " " + std::to_string(found.*m.value) + "  ";
  EXPECT_FALSE(render::within(found, {})) << size.width << "x" << size.height << ": " << figures;
}

void expect_seen_in(const PlantedPicture& shown, Size size, const std::function<void(render::DrawList&)>& plant) {
  const render::DrawList right = shown.list(size);
  render::DrawList wrong = right;
  plant(wrong);
  expect_seen(right, wrong, size);
}

/// Turns the bodies of a person whose names hold one of `parts` about a joint, as a wrong joint angle would.
engine::Recording with_limb_turned(const PlantedPicture& shown, const std::vector<std::string>& parts, const std::string& first,
                                   double angle) {
  engine::Recording out = shown.run;
  for (engine::Snapshot& snapshot : out.snapshots) {
    engine::Vec3 centre = engine::Vec3::Zero();
    const auto of = [&](const std::string& part, auto act) {
      for (std::size_t b = 0; b < out.body_names.size(); ++b)
        if (out.body_names[b].find(part) != std::string::npos) act(snapshot.bodies.own()[b].X_WB);
    };
    of(first, [&](engine::Pose& X) { centre = X * engine::Vec3(0, 0, 0.15); });
    const engine::Quat turn(Eigen::AngleAxisd(angle, engine::Vec3::UnitY()));
    for (const std::string& part : parts)
      of(part, [&](engine::Pose& X) {
        X.p = centre + turn * (X.p - centre);
        X.q = turn * X.q;
      });
  }
  return out;
}

TEST(PlantedFault, AThinLineMovedByAPixel) {
  const PlantedPicture& shown = contact();
  for (const Size size : {kLarge, kSmall}) {
    render::DrawList right = shown.list(size);
    // across the road, as thin as lines are drawn; two pixels of a picture of 1080 lines
    right.lines.push_back({{{-4, -1, 0.6f}, {6, -1, 0.6f}}, {1, 1, 1, 1}, 2, false, render::Occluded::shown, {}});
    render::DrawList wrong = right;
    // moved up the screen: y of clip space spans two over the height
    const render::View& view = right.view;
    const engine::Vec3 eye(view.eye[0], view.eye[1], view.eye[2]);
    const double distance = (eye - engine::Vec3(1, -1, 0.6)).norm();
    const double pixel = 2 * distance / (static_cast<double>(view.eye_to_clip[5]) * size.height);
    for (render::Float3& point : wrong.lines.back().points) point[2] += static_cast<float>(pixel);
    expect_seen(right, wrong, size);
  }
}

TEST(PlantedFault, AContactArrowMissing) {
  for (const Size size : {kLarge, kSmall})
    expect_seen_in(contact(), size, [](render::DrawList& list) {
      ASSERT_FALSE(list.arrows.empty());
      list.arrows.pop_back();
    });
}

TEST(PlantedFault, AContactMarkerMissing) {
  for (const Size size : {kLarge, kSmall})
    expect_seen_in(contact(), size, [](render::DrawList& list) {
      ASSERT_FALSE(list.markers.empty());
      list.markers.pop_back();
    });
}

/// 0 for 8: the digits that look most alike.
void wrong_digit(render::DrawList& list, std::size_t line) {
  for (render::LabelItem& label : list.labels) {
    if (!label.lines.front().starts_with("t = ")) continue;
    const std::size_t at = label.lines.at(line).find_last_of("0123456789");
    ASSERT_NE(at, std::string::npos);
    label.lines[line][at] = label.lines[line][at] == '8' ? '0' : '8';
    return;
  }
  FAIL() << "the picture has no caption";
}

TEST(PlantedFault, AWrongDigitInTheClock) {
  for (const Size size : {kLarge, kSmall}) expect_seen_in(contact(), size, [](render::DrawList& list) { wrong_digit(list, 0); });
}

TEST(PlantedFault, AWrongDigitInTheSpeeds) {
  for (const Size size : {kLarge, kSmall}) expect_seen_in(contact(), size, [](render::DrawList& list) { wrong_digit(list, 1); });
}

TEST(PlantedFault, ALimbTurnedByADegree) {
  PlantedPicture shown("gallery/pose_standing.toml", 0, "side");
  for (const Size size : {kLarge, kSmall}) {
    const render::DrawList right = shown.list(size);
    PlantedPicture turned = shown;
    turned.run = with_limb_turned(shown, {"left_upper_arm", "left_forearm", "left_hand"}, "left_upper_arm", 0.0174533);
    expect_seen(right, turned.list(size), size);
    turned.run = with_limb_turned(shown, {"right_forearm", "right_hand"}, "right_forearm", 0.0174533);
    expect_seen(right, turned.list(size), size);
  }
}

TEST(PlantedFault, APaintAShadeDarker) {
  for (const Size size : {kLarge, kSmall})
    expect_seen_in(contact(), size, [](render::DrawList& list) {
      for (render::MeshItem& mesh : list.meshes)
        for (render::Material& material : mesh.materials)
          for (float& c : material.colour) c *= 0.9f;
    });
}

TEST(PlantedFault, ALabelMissing) {
  for (const Size size : {kLarge, kSmall}) expect_seen_in(contact(), size, [](render::DrawList& list) { list.labels.pop_back(); });
}

TEST(Harmless, WhatAnotherProcessorDoesIsPassed) {
  const render::Image right = draw(contact().list(kLarge), kLarge);
  // seen between processors: 16 of 518,400 pixels by 1/255; here strewn, in a row and in a block, up and down
  const auto off_by_one = [&right](const std::function<std::size_t(std::size_t)>& place) {
    render::Image wrong = right;
    for (std::size_t i = 0; i < 16; ++i) {
      std::uint8_t* rgba = &wrong.rgba[4 * place(i)];
      for (int c = 0; c < 3; ++c) rgba[c] = static_cast<std::uint8_t>(rgba[c] > 128 ? rgba[c] - 1 : rgba[c] + 1);
    }
    return wrong;
  };
  const std::size_t width = static_cast<std::size_t>(kLarge.width);
  for (const std::size_t from : {100 * width + 300, 300 * width + 500, 500 * width + 20}) {
    const render::Image wrong[] = {off_by_one([](std::size_t i) { return i * 32003 + 77; }),
                                   off_by_one([from](std::size_t i) { return from + i; }),
                                   off_by_one([from](std::size_t i) { return from + i % 4 + (i / 4) * width; })};
    for (const render::Image& picture : wrong) {
      const render::Difference found = render::difference_of(right, picture);
      EXPECT_EQ(found.differing, 16);
      EXPECT_EQ(found.largest, 1);
      // half of the limit is left for pictures in which they fall together worse
      EXPECT_LT(found.perceptual_worst, render::Limits{}.perceptual_worst / 2);
      EXPECT_TRUE(render::within(found, {}));
    }
  }
}

TEST(Harmless, TheSameMomentDrawnAgainIsTheSameToTheBit) {
  const PlantedPicture& shown = contact();
  EXPECT_EQ(render::difference_of(draw(shown.list(kLarge), kLarge), draw(shown.list(kLarge), kLarge)).differing, 0);
}

}  // namespace
