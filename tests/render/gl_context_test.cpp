// What OpenGL a machine has: pictures do not depend on its vectors, and where there is none that serves, the program says so.
#include "render/gl/context.h"

#include <gmock/gmock.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "render/error.h"
#include "render/gl/target.h"

namespace render {
namespace {

struct Ran {
  int code = 0;
  std::string picture;  // its bytes
  std::string words;
  bool left = false;  // anything beside the picture
};

/// A still by the program in a folder of its own, with these variables of the environment set.
Ran run(const std::string& variables, const std::string& options = "") {
  namespace fs = std::filesystem;
  const fs::path folder = fs::temp_directory_path() / ("gl_context_test_" + std::to_string(getpid()));
  fs::remove_all(folder);
  fs::create_directories(folder / "out");
  const std::string command = "env " + variables +
                              " " CRASHREEL_PROGRAM " render " CRASHREEL_SOURCE_DIR
                              "/scenes/cases/thrown_body.toml --camera side --at 0.3s --size 320x180 " +
                              options + " -o " + (folder / "out/still.png").string() + " > /dev/null 2> " +
                              (folder / "words").string();
  const auto bytes = [](const fs::path& file) {
    std::ostringstream text;
    text << std::ifstream(file, std::ios::binary).rdbuf();
    return text.str();
  };
  Ran out;
  out.code = WEXITSTATUS(std::system(command.c_str()));
  out.words = bytes(folder / "words");
  out.picture = bytes(folder / "out/still.png");
  fs::remove(folder / "out/still.png");
  out.left = !fs::is_empty(folder / "out");
  fs::remove_all(folder);
  return out;
}

TEST(GlContext, PicturesAreTheSameWhateverVectorsTheProcessorHas) {
  const Ran here = run("CRASHREEL_HOME=" CRASHREEL_SOURCE_DIR);
  ASSERT_EQ(here.code, 0) << here.words;
  ASSERT_GT(here.picture.size(), 5000u);
  for (const char* other : {"LP_NATIVE_VECTOR_WIDTH=128", "GLIBC_TUNABLES=glibc.cpu.hwcaps=-FMA,-FMA4,-AVX2"})
    EXPECT_TRUE(run(std::string("CRASHREEL_HOME=" CRASHREEL_SOURCE_DIR " ") + other).picture == here.picture) << other;
}

TEST(GlContext, ThatIsMissingOrTooOldIsSaid) {
  const struct {
    const char *variables, *options, *asked, *got;
  } cases[] = {
      {"MESA_GL_VERSION_OVERRIDE=3.0", "", "OpenGL 3.3 core was asked of OSMesa", "it gave no context"},
      {"MESA_GL_VERSION_OVERRIDE=3.0", "--gl egl", "OpenGL 3.3 core was asked of EGL", "making the context failed with 0x3009"},
      {"__EGL_VENDOR_LIBRARY_FILENAMES=/nonexistent", "--gl egl", "OpenGL 3.3 core was asked of EGL",
       "opening the display failed"}};
  for (const auto& c : cases) {
    const Ran ran = run(std::string("CRASHREEL_HOME=" CRASHREEL_SOURCE_DIR " ") + c.variables, c.options);
    EXPECT_EQ(ran.code, 3) << c.variables << " " << c.options;
    EXPECT_THAT(ran.words, testing::AllOf(testing::HasSubstr(c.asked), testing::HasSubstr(c.got)));
    EXPECT_TRUE(ran.picture.empty() && !ran.left) << "nothing half-written";
  }
}

TEST(GlContext, ASizeThatTheDriverRefusesIsSaid) {
  const GlContext context;
  gl::Target target("shadow map");
  try {
    target.begin({0, 0, 40000, 16}, 40000, 16);
    FAIL() << "no driver has textures so large";
  } catch (const RenderError& error) {
    EXPECT_THAT(error.what(),
                testing::MatchesRegex("creating the shadow map: OpenGL refuses 40000 x 16 samples .*allows [0-9]+ a side.*"));
  }
  target.begin({0, 0, 64, 16}, 64, 16);  // and draws on
  float depth = 0;
  target.read({63, 15, 1, 1}, &depth);
  EXPECT_EQ(depth, 1);
}

}  // namespace
}  // namespace render
