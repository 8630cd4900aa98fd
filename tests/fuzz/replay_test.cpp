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

/// What the program writes today, then what lies in the folder.
std::vector<std::string> corpus_of(const fuzz::Target& target) {
  const std::filesystem::path folder = std::filesystem::path(CRASHREEL_SOURCE_DIR) / "tests/fuzz/corpus" / target.name;
  std::vector<std::filesystem::path> files;
  if (std::filesystem::exists(folder))
    for (const auto& entry : std::filesystem::directory_iterator(folder)) files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  std::vector<std::string> out = target.written ? target.written() : std::vector<std::string>();
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
class Corpus : public testing::TestWithParam<fuzz::Target> {};

TEST_P(Corpus, BreaksNoPromise) {
  const std::vector<std::string> inputs = corpus_of(GetParam());
  EXPECT_FALSE(inputs.empty());
  for (const std::string& input : inputs) GetParam().run(input);
}

TEST_P(Corpus, BreaksNoPromiseWhereItIsMutated) {
  const std::vector<std::string> inputs = corpus_of(GetParam());
  std::mt19937 chance(7);
  for (const std::string& input : inputs)
    for (int i = 0; i < GetParam().mutants; ++i) GetParam().run(mutated(input, inputs, chance));
}

INSTANTIATE_TEST_SUITE_P(Targets, Corpus, testing::ValuesIn(fuzz::targets().begin(), fuzz::targets().end()),
                         [](const auto& target) { return std::string(target.param.name); });
