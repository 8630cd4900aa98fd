#include <gtest/gtest.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <random>
#include <string>

#include "render/image/deflate.h"

namespace render {
namespace {

using Bytes = std::vector<std::uint8_t>;

/// By the library that reads what is written.
Bytes inflated(const Bytes& stream, std::size_t size) {
  Bytes out(size + 1);
  uLongf length = out.size();
  EXPECT_EQ(uncompress(out.data(), &length, stream.data(), stream.size()), Z_OK);
  out.resize(length);
  return out;
}

void comes_back(const Bytes& bytes, const std::string& what) {
  EXPECT_EQ(inflated(deflate_runs(bytes), bytes.size()), bytes) << what;
}

TEST(DeflateRuns, ComesBackWhateverTheBytes) {
  comes_back({}, "none");
  comes_back({7}, "one");
  std::mt19937 random(1);
  for (const std::size_t size : {2u, 5u, 300u, 70'000u, 600'000u}) {
    Bytes noise(size), steps(size), rare(size);
    for (std::size_t i = 0; i < size; ++i) {
      noise[i] = static_cast<std::uint8_t>(random());
      steps[i] = random() % 9 == 0 ? static_cast<std::uint8_t>(random()) : steps[i > 0 ? i - 1 : 0];
      rare[i] = static_cast<std::uint8_t>(std::min(255, std::countr_zero(random() | 1u << 31) * 8));
    }
    comes_back(noise, "noise");
    comes_back(steps, "runs of all short lengths");
    comes_back(rare, "each byte half as often as the one before");
    comes_back(Bytes(size, 9), "one byte over and over");
  }
}

TEST(DeflateRuns, RunsOfEveryLengthMatchesHave) {
  for (std::size_t n = 1; n < 600; ++n) {
    Bytes bytes(n, 3);
    bytes.push_back(4);
    comes_back(bytes, std::to_string(n));
  }
}

TEST(DeflateRuns, KeepsCodesShortWhereCountsGrowLikeFibonaccis) {
  // the deepest tree Huffman can make: 24 symbols, 24 bits
  Bytes bytes;
  std::size_t a = 1, b = 1;
  for (std::uint8_t s = 0; s < 24; ++s) {
    for (std::size_t i = 0; i < a; ++i) bytes.push_back(s);
    const std::size_t sum = a + b;
    a = b;
    b = sum;
  }
  std::shuffle(bytes.begin(), bytes.end(), std::mt19937(2));
  comes_back(bytes, "Fibonacci");
}

TEST(DeflateRuns, NoiseTakesLittleMoreThanItsEntropy) {
  // sums of bits, as the grain of asphalt differs from pixel to pixel; runs of four are rare
  std::mt19937 random(3);
  Bytes bytes(400'000);
  std::array<double, 33> counts{};
  for (std::uint8_t& byte : bytes) ++counts[byte = static_cast<std::uint8_t>(std::popcount(random()))];
  double bits = 0;
  for (const double c : counts)
    if (c > 0) bits -= c * std::log2(c / 400'000);
  // whole bits a symbol cost Huffman's code some hundredths of one
  EXPECT_LT(static_cast<double>(deflate_runs(bytes).size()), 1.03 * bits / 8);
}

}  // namespace
}  // namespace render
