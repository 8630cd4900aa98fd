// The scene format's table, its reference in the README, its JSON Schema, and every shipped scene against it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "engine/effects/effect.h"
#include "scene_file.h"
#include "scenes/loader/sha256.h"
#include "scenes/loader/table.h"

namespace scenes {
namespace {

using ::testing::UnorderedElementsAre;

const std::filesystem::path kSource = CRASHREEL_SOURCE_DIR;

std::string contents(const std::filesystem::path& file) {
  std::ostringstream out;
  out << std::ifstream(file).rdbuf();
  return out.str();
}

TEST(Reference, OfTheReadmeIsTheOneTheTableWrites) {
  const std::string readme = contents(kSource / "scenes/README.md");
  for (const Section* section : all_sections()) {
    for (const Key& key : section->keys) {
      const std::string row = key.name == "*" ? "| `(any name)` |" : "| `" + std::string(key.name) + "` |";
      EXPECT_NE(readme.find(row), std::string::npos) << section->header << " " << key.name;
    }
  }
  const bool same = readme.find(reference_markdown()) != std::string::npos;
  const std::filesystem::path file = std::filesystem::path(::testing::TempDir()) / "reference.md";
  if (!same) std::ofstream(file) << reference_markdown();
  EXPECT_TRUE(same) << "put the text of " << file << " in place of the reference in scenes/README.md";
}

TEST(Reference, SaysSomethingOfEveryKey) {
  for (const Section* section : all_sections()) {
    EXPECT_FALSE(section->doc.empty()) << section->header;
    for (const Key& key : section->keys) {
      EXPECT_FALSE(key.doc.empty()) << section->header << " " << key.name;
      EXPECT_EQ(key.type == Type::choice, !key.choices.empty()) << section->header << " " << key.name;
    }
  }
}

/// Keys that stand in one line with the field they go into, and those whose reader needs more than the value.
TEST(Reference, BindsEveryKeyToAFieldUnlessItsValueNeedsTheSceneAround) {
  const auto is_of_effect = [](const Section& section) {
    const auto effects = engine::effect_table();
    return std::any_of(effects.begin(), effects.end(), [&](const auto* effect) { return effect->section.name == section.name; });
  };
  std::vector<std::string> unbound;
  int bound = 0;
  for (const Section* section : all_sections()) {
    if (is_of_effect(*section)) continue;  // go into Model::inputs by their names
    for (const Key& key : section->keys) {
      if (section->name == "overlays" && (key.type == Type::boolean || key.type == Type::number)) continue;  // into Overlays so
      const bool holds_others = key.section != nullptr;
      const bool is_any_name = key.name == "*";
      if (key.fill) ++bound;
      if (!key.fill && !holds_others && !is_any_name) unbound.push_back(std::string(section->name) + "." + std::string(key.name));
    }
  }
  EXPECT_GT(bound, 287);
  EXPECT_THAT(
      unbound,
      UnorderedElementsAre(
          // a file that is read
          "ground.terrain", "vehicle.mesh", "vehicle.collision_mesh", "vehicle.wheel_mesh", "vehicle.wheel.mesh", "body.mesh",
          "road.picture",
          // the name of another thing, or of a file of the library
          "vehicle.model", "vehicle.towed_by", "person.figure", "person.pose", "person.rides", "joint.parent", "joint.child",
          "impact.a", "impact.b", "overlays.dimension.body", "figure.joint.parent", "figure.joint.child",
          // of the dimension of what they speak of
          "uncertain.uniform", "uncertain.normal", "uncertain.triangular", "uncertain.log_normal", "uncertain.choice",
          "uncertain.table", "uncertain.within", "evidence.mark", "evidence.value", "evidence.tolerance",
          // limits by their names, where they are given
          "snapshot.limits.share_above_2", "snapshot.limits.pixels_above_32", "snapshot.limits.rms", "snapshot.limits.psnr_dB",
          "snapshot.limits.ssim", "snapshot.limits.perceptual_mean", "snapshot.limits.perceptual_worst"));
}

TEST(JsonSchema, KnowsTheKeysTheLoaderKnows) {
  const auto schema = nlohmann::json::parse(json_schema());
  EXPECT_EQ(schema["$schema"], "https://json-schema.org/draft/2020-12/schema");
  for (const Key& key : scene_section().keys) EXPECT_TRUE(schema["properties"].contains(std::string(key.name))) << key.name;
  EXPECT_EQ(schema["properties"]["body"]["items"]["properties"]["exponent"]["anyOf"][0]["minimum"], 2);
  EXPECT_EQ(schema["properties"]["person"]["items"]["properties"]["segment"]["additionalProperties"]["type"], "object");
  EXPECT_EQ(schema["properties"]["camera"]["items"]["required"], nlohmann::json::array({"name"}));
}

class ShippedScenes : public ::testing::TestWithParam<std::filesystem::path> {};

TEST_P(ShippedScenes, Load) {
  const Scene scene = load(GetParam());
  EXPECT_FALSE(scene.title.empty());
  EXPECT_FALSE(scene.stage.cameras.empty());
  EXPECT_FALSE(scene.model.bodies.empty());
  EXPECT_TRUE(scene.warnings.empty()) << scene.warnings.front();
}

std::vector<std::filesystem::path> shipped() {
  std::vector<std::filesystem::path> out;
  for (const char* folder : {"scenes/gallery", "scenes/cases"}) {
    for (const auto& entry : std::filesystem::directory_iterator(kSource / folder))
      if (entry.path().extension() == ".toml") out.push_back(entry.path());
  }
  std::sort(out.begin(), out.end());
  return out;
}

INSTANTIATE_TEST_SUITE_P(All, ShippedScenes, ::testing::ValuesIn(shipped()),
                         [](const auto& one) { return one.param.stem().string(); });

TEST(Sha256, GivesTheAnswersOfTheStandard) {
  // FIPS 180-4 examples: one block, two blocks, nothing
  EXPECT_EQ(sha256("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  EXPECT_EQ(sha256("abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq"),
            "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1");
  EXPECT_EQ(sha256(""), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
}

}  // namespace
}  // namespace scenes
