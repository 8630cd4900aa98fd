// SHA-256, FIPS 180-4 section 6.2, in the standard's letters. The round constants are derived, as the standard defines them:
// the first 32 bits of the fractional parts of the square and cube roots of the first primes.
#include "scenes/loader/sha256.h"

#include <fmt/format.h>

#include <array>
#include <bit>
#include <cstdint>

namespace scenes {
namespace {

using Word = std::uint32_t;

/// floor(2^32 * frac(p^(1/k))), k 2 or 3, in whole numbers: the root of p * 2^(32k) by bisection.
Word root_fraction(unsigned p, int k) {
  __extension__ using Wide = unsigned __int128;
  std::uint64_t low = 0;
  std::uint64_t high = std::uint64_t{1} << 38;  // the largest root here, sqrt(311), is below 2^5
  while (high - low > 1) {
    const std::uint64_t middle = (low + high) / 2;
    // for cubes compare m^3 with p * 2^96 as m^2 <= p * 2^96 / m, which stays below 2^128
    const Wide square = static_cast<Wide>(middle) * middle;
    const bool below = k == 2 ? square <= (static_cast<Wide>(p) << 64) : square <= (static_cast<Wide>(p) << 96) / middle;
    (below ? low : high) = middle;
  }
  return static_cast<Word>(low);
}

struct Constants {
  std::array<Word, 8> h;
  std::array<Word, 64> k;
  Constants() {
    std::size_t found = 0;
    for (unsigned p = 2; found < 64; ++p) {
      bool prime = true;
      for (unsigned d = 2; d * d <= p; ++d) prime = prime && p % d != 0;
      if (!prime) continue;
      if (found < 8) h[found] = root_fraction(p, 2);
      k[found++] = root_fraction(p, 3);
    }
  }
};

void hash_block(std::array<Word, 8>& h, const std::array<Word, 64>& k, const unsigned char* block) {
  std::array<Word, 64> w;
  for (std::size_t t = 0; t < 16; ++t)
    w[t] = Word{block[4 * t]} << 24 | Word{block[4 * t + 1]} << 16 | Word{block[4 * t + 2]} << 8 | Word{block[4 * t + 3]};
  for (std::size_t t = 16; t < 64; ++t) {
    const Word s0 = std::rotr(w[t - 15], 7) ^ std::rotr(w[t - 15], 18) ^ (w[t - 15] >> 3);
    const Word s1 = std::rotr(w[t - 2], 17) ^ std::rotr(w[t - 2], 19) ^ (w[t - 2] >> 10);
    w[t] = s1 + w[t - 7] + s0 + w[t - 16];
  }
  auto [a, b, c, d, e, f, g, last] = h;
  for (std::size_t t = 0; t < 64; ++t) {
    const Word t1 = last + (std::rotr(e, 6) ^ std::rotr(e, 11) ^ std::rotr(e, 25)) + ((e & f) ^ (~e & g)) + k[t] + w[t];
    const Word t2 = (std::rotr(a, 2) ^ std::rotr(a, 13) ^ std::rotr(a, 22)) + ((a & b) ^ (a & c) ^ (b & c));
    last = g, g = f, f = e, e = d + t1, d = c, c = b, b = a, a = t1 + t2;
  }
  const std::array<Word, 8> add{a, b, c, d, e, f, g, last};
  for (std::size_t i = 0; i < 8; ++i) h[i] += add[i];
}

}  // namespace

std::string sha256(std::string_view bytes) {
  static const Constants constants;
  std::array<Word, 8> h = constants.h;
  const auto take = [&h](std::string_view blocks) {
    for (std::size_t at = 0; at < blocks.size(); at += 64)
      hash_block(h, constants.k, reinterpret_cast<const unsigned char*>(blocks.data()) + at);
  };
  const std::size_t whole = bytes.size() / 64 * 64;
  take(bytes.substr(0, whole));
  // the rest of the message, a one bit, zeros, and the length in bits as 64 bits
  std::string padded(bytes.substr(whole));
  padded += '\x80';
  while (padded.size() % 64 != 56) padded += '\0';
  for (int shift = 56; shift >= 0; shift -= 8) padded += static_cast<char>((std::uint64_t{bytes.size()} * 8) >> shift);
  take(padded);
  std::string out;
  for (Word word : h) out += fmt::format("{:08x}", word);
  return out;
}

}  // namespace scenes
