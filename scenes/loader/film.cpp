// What the scene looks like and how it is filmed; [output] itself.
#include <fmt/format.h>

#include "scenes/loader/builder.h"

namespace scenes {
namespace {

const Key kStillKeys[] = {
    bound<&Output::Still::time>({"time", Type::number, Dimension::time, kRequired, "Simulated time.", kNotNegative}),
    bound<&Output::Still::camera>(
        {"camera", Type::text, Dimension::none, "''", "Camera; left out: seen as the film shows this time, two cameras included."}),
    bound<&Output::Still::card>(
        {"card", Type::integer, Dimension::none, "", "The film's first, second ... card in place of a camera.", between(1, 100)}),
};
const Section kStillSection{"output.still", "[[output.still]]", "Stills a snapshot test draws.", kStillKeys};

const Key kOutputKeys[] = {
    bound<&Output::width>({"width", Type::integer, Dimension::none, "1280", "Picture width in pixels, even.", between(16, 8192)}),
    bound<&Output::height>({"height", Type::integer, Dimension::none, "720", "Picture height in pixels, even.", between(16, 8192)}),
    bound<&Output::fps>({"fps", Type::number, Dimension::none, "30", "Frames a second.", between(1, 1000)}),
    bound<&Output::quality>(
        {"quality", Type::choice, Dimension::none, "'standard'", "Effort a frame.", kAny, "draft|standard|fine"}),
    {"still", Type::tables, Dimension::none, "", "Stills for snapshot tests.", kAny, {}, &kStillSection},
};

void read_output(Builder& builder, Reader r) {
  Output& out = builder.scene.output;
  r.fill(out);
  constexpr const char* kEven = "must be even; the video's colour is stored for pairs of pixels";
  if (out.width % 2 != 0) r.fail("width", kEven);
  if (out.height % 2 != 0) r.fail("height", kEven);
  for (Reader& still : r.tables("still")) {
    Output::Still& drawn = out.stills.emplace_back();
    still.fill(drawn);
    if (!drawn.camera.empty()) check_camera_name(builder, still, drawn.camera, "camera");
    if (still.has("card")) --drawn.card;  // counted from 0 in the stage
    const int cards = static_cast<int>(builder.scene.stage.cards.size());
    if (drawn.card >= cards) still.fail("card", fmt::format("must be one of the scene's {} cards", cards));
  }
}

}  // namespace

const Section kOutputSection{"output", "[output]", "Size and rate of pictures; the command line overrides.", kOutputKeys};

void read_film(Builder& builder, Reader& scene) {
  const auto section = [&](std::string_view key, const Section& s) {
    const auto reader = scene.table(key);
    return reader ? *reader : Reader(empty_table(), s, std::string(key), builder.errors);
  };
  read_cameras(builder, scene);
  read_overlays(builder, section("overlays", kOverlaysSection));
  read_output(builder, section("output", kOutputSection));
  read_road_and_sky(builder, section("road", kRoadSection), section("sky", kSkySection));
}

}  // namespace scenes
