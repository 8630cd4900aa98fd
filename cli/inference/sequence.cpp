#include "cli/inference/sequence.h"

#include <boost/random/sobol.hpp>

namespace cli::inference {
namespace {

constexpr int kBits = 32;  // 4 thousand million points, far more than runs

std::uint32_t scrambled(std::uint32_t x, std::uint64_t key) {
  std::uint32_t out = 0;
  std::uint64_t node = 1;  // the digits so far, with a leading one: where in the tree of digits we are
  for (int bit = kBits - 1; bit >= 0; --bit) {
    const std::uint32_t digit = (x >> bit) & 1u;
    const auto swap = static_cast<std::uint32_t>(mixed(key ^ (node * 0x9e3779b97f4a7c15ull)) >> 63);
    out |= (digit ^ swap) << bit;
    node = (node << 1) | digit;
  }
  return out;
}

}  // namespace

std::uint64_t mixed(std::uint64_t x) {
  // multiply and shift until every bit hangs on every other (finaliser of the splitmix generator, Steele, Lea and Flood 2014)
  x += 0x9e3779b97f4a7c15ull;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9ull;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebull;
  return x ^ (x >> 31);
}

std::vector<std::vector<double>> scrambled_points(int dimensions, std::uint64_t from, std::uint64_t count, std::uint64_t seed) {
  using Engine = boost::random::sobol_engine<std::uint32_t, kBits>;
  Engine engine(static_cast<std::size_t>(dimensions));
  // Boost leaves out the first point, the origin; without it 2^k points are no net
  if (from > 0) engine.discard((from - 1) * static_cast<std::uint64_t>(dimensions));
  std::uint64_t index = from;
  std::vector<std::vector<double>> out(count, std::vector<double>(static_cast<std::size_t>(dimensions)));
  for (auto& point : out) {
    const bool origin = index++ == 0;
    for (int k = 0; k < dimensions; ++k) {
      const auto raw = origin ? 0u : static_cast<std::uint32_t>(engine());
      // the middle of the cell: neither 0 nor 1, whose normal scores are infinite
      point[static_cast<std::size_t>(k)] =
          (scrambled(raw, mixed(seed + 0x1000003ull * static_cast<std::uint64_t>(k))) + 0.5) * 0x1p-32;
    }
  }
  return out;
}

}  // namespace cli::inference
