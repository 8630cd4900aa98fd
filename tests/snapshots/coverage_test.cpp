// The gallery's snapshots show everything there is to draw: a new overlay, camera, layout, appearance or material without one
// fails.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "cli/snapshot/baselines.h"
#include "engine/simulate.h"
#include "render/overlays/overlay.h"
#include "scenes/scene.h"

namespace {

using namespace render;

/// What all pictures of the gallery show, by name or number.
struct Shown {
  std::set<std::string> overlays;
  std::set<CameraKind> cameras;
  std::set<Layout> layouts;
  std::set<PersonLook> looks;
  std::set<MaterialKind> materials;
  std::set<bool> card_at_end, road, terrain, ground_picture;
};

/// How much is in a list, whatever it is.
std::size_t amount(const DrawList& l) {
  return l.ellipsoids.size() + l.meshes.size() + l.skins.size() + l.strips.size() + l.lines.size() + l.arrows.size() +
         l.markers.size() + l.labels.size() + l.charts.size() + l.reserved.size();
}

void take_view(const scenes::Scene& scene, const engine::Recording& run, const Moment& moment, const std::string& name,
               Shown& shown) {
  const Stage& stage = scene.stage;
  const auto camera =
      std::find_if(stage.cameras.begin(), stage.cameras.end(), [&](const Camera& c) { return name.empty() || c.name == name; });
  ASSERT_NE(camera, stage.cameras.end()) << scene.path << ": " << name;
  shown.cameras.insert(camera->kind);
  const engine::Snapshot now = run.at(moment.time);
  Moment seen = moment;
  seen.camera = camera->name;
  const Frame frame{stage, run, now, seen, *camera};
  // an eye sees no overlays; elsewhere one counts that is shown and adds something
  for (const Overlay* overlay : overlay_table()) {
    if (camera->kind == CameraKind::eye || !overlay->shown_in(frame)) continue;
    DrawList list = arrange(stage, run, seen, 16.0 / 9, Layer::scene);
    const std::size_t before = amount(list);
    overlay->add(frame, list);
    if (amount(list) > before) shown.overlays.insert(overlay->name);
  }
  const DrawList list = arrange(stage, run, seen, 16.0 / 9);
  for (const EllipsoidItem& e : list.ellipsoids) shown.materials.insert(e.material.kind);
  for (const MeshItem& m : list.meshes)
    for (const Material& material : m.materials) shown.materials.insert(material.kind);
  for (const PersonActor& person : stage.persons) shown.looks.insert(person.look);
  shown.road.insert(list.road.road);
  shown.terrain.insert(list.road.terrain != nullptr);
  shown.ground_picture.insert(list.road.picture != nullptr);
}

Shown shown_by_the_gallery() {
  Shown shown;
  for (const auto& file : cli::find_scenes(std::filesystem::path(CRASHREEL_SOURCE_DIR) / "scenes/gallery")) {
    const scenes::Scene scene = scenes::load(file);
    const std::vector<cli::Still> stills = cli::stills_of(scene);
    if (stills.empty()) continue;
    const engine::Recording run = engine::simulate(scene.model);
    for (const cli::Still& still : stills) {
      if (still.moment.card >= 0) {
        shown.card_at_end.insert(scene.stage.cards[static_cast<std::size_t>(still.moment.card)].at_end);
        continue;
      }
      shown.layouts.insert(still.moment.layout);
      take_view(scene, run, still.moment, still.moment.camera, shown);
      if (still.moment.layout != Layout::single) take_view(scene, run, still.moment, still.moment.second, shown);
    }
  }
  return shown;
}

template <typename Enum>
std::set<Enum> all_up_to(Enum last) {
  std::set<Enum> out;
  for (int i = 0; i <= static_cast<int>(last); ++i) out.insert(static_cast<Enum>(i));
  return out;
}

TEST(Gallery, ShowsEverythingThereIsToDraw) {
  const Shown shown = shown_by_the_gallery();
  std::set<std::string> overlays;
  for (const Overlay* overlay : overlay_table()) overlays.insert(overlay->name);
  EXPECT_THAT(shown.overlays, testing::ContainerEq(overlays));
  EXPECT_EQ(shown.cameras, all_up_to(CameraKind::path));
  EXPECT_EQ(shown.layouts, all_up_to(Layout::inset));
  EXPECT_EQ(shown.looks, all_up_to(PersonLook::raster));
  EXPECT_EQ(shown.materials, all_up_to(MaterialKind::cloth));
  const std::set<bool> both{false, true};
  EXPECT_EQ(shown.card_at_end, both);
  EXPECT_EQ(shown.road, both);
  EXPECT_EQ(shown.terrain, both);
  EXPECT_EQ(shown.ground_picture, both);
}

}  // namespace
