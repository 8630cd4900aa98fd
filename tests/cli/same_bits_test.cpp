// The same recording on every processor. glibc takes its mathematical functions by what the processor can do, and so may a library
// of ours; a processor without fused multiply-add and AVX2 is tried twice: as glibc is told of it, and emulated.
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "tests/cli/program.h"

namespace {

namespace fs = std::filesystem;
using cli_tests::Folder;

const fs::path kScenes = fs::path(CRASHREEL_SOURCE_DIR) / "scenes";

struct Opening {
  const char* scene;
  const char* end;  // long enough for its contacts
};

class SameBits : public testing::TestWithParam<Opening> {};

/// Hash of a scene's recording, run by `prefix` crashreel (an emulator and its options; may be empty).
std::string hash_of(const Folder& folder, const Opening& of, const std::string& prefix) {
  const std::string out = (folder / "run").string();
  const std::string command = prefix + " '" + cli_tests::program() + "' simulate '" + (kScenes / of.scene).string() +
                              "' --set simulation.duration=" + of.end + " --overwrite --json -o '" + out + "' > '" + out +
                              ".json' 2> '" + out + ".err'";
  EXPECT_EQ(std::system(command.c_str()), 0) << command << "\n" << cli_tests::contents(out + ".err");
  return nlohmann::json::parse(cli_tests::contents(out + ".json")).at("recording").at("hash");
}

}  // namespace

TEST_P(SameBits, WithoutFusedMultiplyAddAndWideVectors) {
  const Folder folder;
  EXPECT_EQ(hash_of(folder, GetParam(), ""), hash_of(folder, GetParam(), "GLIBC_TUNABLES=glibc.cpu.hwcaps=-FMA,-AVX2"));
}

INSTANTIATE_TEST_SUITE_P(Scenes, SameBits,
                         testing::Values(Opening{"cases/sedan_pedestrian_40kmh.toml", "'1.5 s'"},
                                         Opening{"cases/cyclist.toml", "'0.8 s'"}, Opening{"cases/thrown_body.toml", "'1 s'"},
                                         Opening{"cases/rollover.toml", "'1 s'"},
                                         Opening{"cases/car_steered_trailer.toml", "'1 s'"},
                                         Opening{"gallery/projectile_slide.toml", "'1 s'"},
                                         Opening{"gallery/puck_slide.toml", "'1 s'"}, Opening{"gallery/wind.toml", "'1 s'"}),
                         [](const auto& tried) { return fs::path(tried.param.scene).stem().string(); });

TEST(SameBitsEmulated, AProcessorOf2008FindsTheSameRecording) {
  const Folder folder;
  const Opening collision{"cases/sedan_pedestrian_40kmh.toml", "'0.25 s'"};
  EXPECT_EQ(hash_of(folder, collision, ""), hash_of(folder, collision, "qemu-x86_64 -cpu Nehalem"));
}
