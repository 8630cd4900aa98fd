// [road], [sky]: what ground and light look like.
#include <fmt/format.h>

#include "scenes/loader/builder.h"
#include "scenes/loader/sha256.h"

namespace scenes {
namespace {

struct GroundPicturePlace {
  engine::Vec3 corner = engine::Vec3::Zero();  // [m] world x, y
};

const Key kRoadKeys[] = {
    bound_to_first_word<&render::RoadLook::road>({"kind", Type::choice, Dimension::none, "'plain'",
                                                  "Asphalt with lane markings along x, or plain ground with a metre grid.", kAny,
                                                  "road|plain"}),
    bound<&render::RoadLook::width>({"width", Type::number, Dimension::length, "'7 m'", "Kerb to kerb.", kPositive}),
    bound<&render::RoadLook::centre_y>({"centre_y", Type::number, Dimension::length, "'0 m'",
                                        "Where its middle runs. Traffic keeps right: lanes along +x lie at smaller y."}),
    bound<&render::RoadLook::lanes>({"lanes", Type::integer, Dimension::none, "2", "Lanes in all.", between(1, 12)}),
    bound<&render::RoadLook::metre_grid>(
        {"grid", Type::boolean, Dimension::none, "false", "A grid of metres on the road as well."}),
    bound<&render::RoadLook::zebra_x>(
        {"zebra", Type::number, Dimension::length, "", "x of a pedestrian crossing; left out: none."}),
    {"picture", Type::path, Dimension::none, "", "A PNG that lies on the ground: an aerial photograph, a drawing to scale."},
    bound<&render::RoadLook::picture_width>(
        {"picture_width", Type::number, Dimension::length, "'50 m'", "How wide the picture is on the ground.", kPositive}),
    bound<&GroundPicturePlace::corner>(
        {"picture_corner", Type::vector2, Dimension::length, "'0 0 m'", "Where its lower left corner lies."}),
    bound<&render::RoadLook::picture_turn>(
        {"picture_heading", Type::number, Dimension::angle, "'0 deg'", "Where its lower edge points, from +x towards +y."}),
};

const Key kSkyKeys[] = {
    bound<&render::Stage::north>({"north", Type::number, Dimension::angle, "",
                                  "Where north is, from +x towards +y; top views show it. Left out: they show x."}),
    bound<&render::SkyLook::sun_azimuth>(
        {"sun_azimuth", Type::number, Dimension::angle, "'130 deg'", "Direction to the sun, from +x towards +y."}),
    bound<&render::SkyLook::sun_elevation>(
        {"sun_elevation", Type::number, Dimension::angle, "'46 deg'", "Height of the sun.", between(0.02, 1.5707964)}),
    bound<&render::SkyLook::haze>({"haze", Type::number, Dimension::none, "0.4", "0 clear, 1 fog.", kShare}),
};

/// Of what is drawn, not of a second look at the file.
std::string pixels_hash(const render::GroundPicture& picture) {
  const render::GroundPicture::Level& level = picture.levels.front();
  return sha256(fmt::format("{}x{}", level.width, level.height) +
                sha256({reinterpret_cast<const char*>(level.texels.data()), level.texels.size() * sizeof level.texels[0]}));
}

/// A picture beside the scene, or of the program.
void read_ground_picture(Builder& builder, Reader& r, render::RoadLook& look) {
  const std::filesystem::path file = asset_file(builder, r, "picture", "a PNG file");
  if (file.empty()) return;
  std::string problem;
  look.picture = render::read_ground_picture(file, problem);
  if (!look.picture) {
    r.fail("picture", problem);
    return;
  }
  builder.assets += pixels_hash(*look.picture);
  GroundPicturePlace place;
  r.fill(place);
  look.picture_x = place.corner.x();
  look.picture_y = place.corner.y();
}

}  // namespace

const Section kRoadSection{"road", "[road]", "What the ground plane looks like; its friction stands in [ground].", kRoadKeys};
const Section kSkySection{"sky", "[sky]", "Sun and air.", kSkyKeys};

void read_road_and_sky(Builder& builder, Reader road, Reader sky) {
  render::RoadLook& look = builder.scene.stage.road;
  road.fill(look);
  const engine::Ground& ground = builder.scene.model.ground;
  // the drawn plane hides what dips below it: where only a terrain is the ground, it lies under all of that
  look.height = ground.plane || !ground.terrain ? ground.height : ground.terrain->bounds().lower.z() - 0.02;
  look.metre_grid = look.metre_grid || !look.road;
  look.zebra = road.has("zebra");
  if (road.has("picture")) read_ground_picture(builder, road, look);
  sky.fill(builder.scene.stage.sky);
  sky.fill(builder.scene.stage);
}

}  // namespace scenes
