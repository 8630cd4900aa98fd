// The corpus with the ordinary compiler: what once broke a promise never does again.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include "tests/fuzz/targets.h"

TEST(Corpus, BreaksNoPromise) {
  for (const fuzz::Target& target : fuzz::targets()) {
    const std::filesystem::path folder = std::filesystem::path(CRASHREEL_SOURCE_DIR) / "tests/fuzz/corpus" / target.name;
    int inputs = 0;
    for (const auto& entry : std::filesystem::directory_iterator(folder)) {
      SCOPED_TRACE(entry.path().string());
      std::ifstream in(entry.path(), std::ios::binary);
      const std::string bytes(std::istreambuf_iterator<char>(in), {});
      // a broken promise ends the process
      target.run(bytes);
      ++inputs;
    }
    EXPECT_GT(inputs, 0) << target.name;
  }
}
