// The corpus with the ordinary compiler: what once broke a promise never does again, nor does anything near it.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <string>
#include <vector>

#include "tests/fuzz/targets.h"

namespace {

std::vector<std::string> corpus_of(const fuzz::Target& target) {
  const std::filesystem::path folder = std::filesystem::path(CRASHREEL_SOURCE_DIR) / "tests/fuzz/corpus" / target.name;
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  std::vector<std::string> out;
  for (const auto& file : files) {
    std::ifstream in(file, std::ios::binary);
    out.emplace_back(std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>());
  }
  return out;
}

/// A few bytes changed, taken out, put in, or taken from another input.
std::string mutated(const std::string& input, const std::vector<std::string>& all, std::mt19937& chance) {
  std::string out = input;
  for (unsigned n = 1 + chance() % 4; n > 0; --n) {
    const std::size_t at = chance() % (out.size() + 1);
    const std::string& other = all[chance() % all.size()];
    switch (chance() % 4) {
      case 0:
        if (at < out.size()) out[at] = static_cast<char>(chance() % 256);
        break;
      case 1:
        out.erase(at, 1 + chance() % 8);
        break;
      case 2:
        out.insert(at, 1, " .,-x:=[]{}\"'\\0919e\n"[chance() % 20]);
        break;
      default:
        if (!other.empty()) out.insert(at, other.substr(chance() % other.size(), 1 + chance() % 40));
    }
  }
  return out;
}

}  // namespace

// a broken promise ends the process
TEST(Corpus, BreaksNoPromise) {
  for (const fuzz::Target& target : fuzz::targets()) {
    const std::vector<std::string> inputs = corpus_of(target);
    EXPECT_FALSE(inputs.empty()) << target.name;
    for (const std::string& input : inputs) target.run(input);
  }
}

TEST(Corpus, BreaksNoPromiseWhereItIsMutated) {
  constexpr int kMutants = 3000;  // of each input
  for (const fuzz::Target& target : fuzz::targets()) {
    const std::vector<std::string> inputs = corpus_of(target);
    std::mt19937 chance(7);
    for (const std::string& input : inputs)
      for (int i = 0; i < kMutants; ++i) target.run(mutated(input, inputs, chance));
  }
}
