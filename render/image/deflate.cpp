// RFC 1951, blocks with their own codes: bytes are literals, a run of a byte is one literal and matches at distance 1.
#include "render/image/deflate.h"

#include <zlib.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstring>
#include <functional>
#include <queue>
#include <utility>

namespace render {
namespace {

constexpr std::size_t kBlock = std::size_t{1} << 18;  // [bytes] that share a code
constexpr std::size_t kShortestRun = 4, kLongestMatch = 258;
constexpr int kLongestCode = 12;     // [bits] four of them and a byte's rest fit 64
constexpr std::size_t kTable = 256;  // [bytes] that a block's codes and end take, and more
constexpr std::size_t kEnd = 256, kSymbols = 286;

/// A match of a length: its symbol, and what tells lengths of one symbol apart.
struct Length {
  std::size_t symbol;
  int extra_bits;
  std::uint32_t extra;
};
Length length_of(std::size_t n) {
  if (n == kLongestMatch) return {285, 0, 0};
  const std::uint32_t from = static_cast<std::uint32_t>(n) - 3;
  if (from < 8) return {257 + from, 0, 0};
  const int bits = std::bit_width(from) - 3;  // each doubling has four symbols
  return {257 + static_cast<std::size_t>(4 * bits) + (from >> bits), bits, from & ((1u << bits) - 1)};
}

struct Run {
  std::size_t from, to;  // without the first of its bytes
};

std::vector<Run> runs_in(std::span<const std::uint8_t> bytes) {
  std::vector<Run> out;
  const std::uint8_t* const p = bytes.data();
  for (std::size_t i = 1; i + kShortestRun <= bytes.size();) {
    std::uint32_t here = 0, before = 0;
    std::memcpy(&here, p + i, sizeof here);
    std::memcpy(&before, p + i - 1, sizeof before);
    if (here != before) {
      // byte i + k differs from the one before it: no run starts up to there
      const std::uint32_t off = here ^ before;
      i += 1 + static_cast<std::size_t>((std::endian::native == std::endian::little ? 31 - std::countl_zero(off) : 0) / 8);
      continue;
    }
    std::size_t to = i + kShortestRun;
    while (to < bytes.size() && p[to] == p[i]) ++to;
    out.push_back({i, to});
    i = to + 1;
  }
  return out;
}

/// Calls `literals` with a stretch of bytes, `match` with a length, in their order.
template <class Literals, class Match>
void walk(std::span<const std::uint8_t> bytes, const std::vector<Run>& runs, Literals literals, Match match) {
  std::size_t at = 0;
  for (const Run& run : runs) {
    literals(bytes.subspan(at, run.from - at));
    for (at = run.from; run.to - at >= 3;) {
      const std::size_t n = std::min(run.to - at, kLongestMatch);
      match(n);
      at += n;
    }
  }
  literals(bytes.subspan(at));
}

using Counts = std::array<std::uint32_t, kSymbols>;
using Lengths = std::array<std::uint8_t, kSymbols>;

/// Lengths of a prefix code after Huffman; counts are halved until the longest is short enough.
Lengths code_lengths(Counts counts) {
  for (;;) {
    std::array<std::size_t, 2 * kSymbols> parent{};
    using Node = std::pair<std::uint32_t, std::size_t>;
    std::priority_queue<Node, std::vector<Node>, std::greater<>> least;
    for (std::size_t s = 0; s < kSymbols; ++s)
      if (counts[s] > 0) least.push({counts[s], s});
    std::size_t next = kSymbols;
    while (least.size() > 1) {
      const Node a = least.top();
      least.pop();
      const Node b = least.top();
      least.pop();
      parent[a.second] = parent[b.second] = next;
      least.push({a.first + b.first, next++});
    }
    std::array<std::uint8_t, 2 * kSymbols> depth{};
    for (std::size_t n = next - 1; n-- > kSymbols;) depth[n] = static_cast<std::uint8_t>(depth[parent[n]] + 1);
    Lengths out{};
    for (std::size_t s = 0; s < kSymbols; ++s)
      if (counts[s] > 0) out[s] = static_cast<std::uint8_t>(depth[parent[s]] + 1);
    if (*std::max_element(out.begin(), out.end()) <= kLongestCode) return out;
    for (std::uint32_t& c : counts) c = (c + 1) / 2;
  }
}

struct Code {
  std::uint32_t bits = 0;
  int length = 0;
};

/// Codes of one length follow each other; they are sent from their highest bit on.
std::array<Code, kSymbols> codes_of(const Lengths& lengths) {
  std::array<Code, kSymbols> out{};
  std::uint32_t code = 0;
  for (int length = 1; length <= kLongestCode; ++length, code <<= 1)
    for (std::size_t s = 0; s < kSymbols; ++s) {
      if (lengths[s] != length) continue;
      std::uint32_t turned = 0;
      for (int i = 0; i < length; ++i) turned |= (code >> i & 1) << (length - 1 - i);
      out[s] = {turned, length};
      ++code;
    }
  return out;
}

/// Bits behind each other from `at` on. Small and copied: a loop keeps its own in registers.
struct Bits {
  std::uint8_t* at;
  std::uint64_t held = 0;
  int count = 0;

  void put(std::uint32_t bits, int n) {
    held |= std::uint64_t{bits} << count;
    count += n;
  }
  void flush() {
    if constexpr (std::endian::native == std::endian::little)
      std::memcpy(at, &held, sizeof held);
    else
      for (std::size_t i = 0; i < sizeof held; ++i) at[i] = static_cast<std::uint8_t>(held >> (8 * i));
    at += count / 8;
    held >>= count & ~7;
    count &= 7;
  }
};

void put_code_table(const Lengths& lengths, Bits& out) {
  out.put(kSymbols - 257, 5);
  out.put(0, 5);  // one distance
  out.put(15, 4);
  // the code of the lengths: 0 to 15 have four bits each, repetitions none; in the order of RFC 1951, 3.2.7
  for (int i = 0; i < 19; ++i) {
    out.put(i < 3 ? 0 : 4, 3);
    out.flush();
  }
  const auto turned = [](std::uint32_t v) { return (v & 1) << 3 | (v & 2) << 1 | (v & 4) >> 1 | (v & 8) >> 3; };
  for (const std::uint8_t length : lengths) {
    out.put(turned(length), 4);
    out.flush();
  }
  out.put(turned(1), 4);
}

void put_block(std::span<const std::uint8_t> bytes, bool last, Bits& out) {
  const std::vector<Run> runs = runs_in(bytes);
  Counts counts{};
  counts[kEnd] = 1;
  std::array<std::array<std::uint32_t, 256>, 4> tally{};  // in turn: a byte often follows its like
  const auto count = [&tally](std::span<const std::uint8_t> literals) {
    std::size_t i = 0;
    for (; i + 4 <= literals.size(); i += 4)
      for (std::size_t k = 0; k < 4; ++k) ++tally[k][literals[i + k]];
    for (; i < literals.size(); ++i) ++tally[0][literals[i]];
  };
  walk(bytes, runs, count, [&counts](std::size_t n) { ++counts[length_of(n).symbol]; });
  for (std::size_t s = 0; s < 256; ++s) counts[s] = tally[0][s] + tally[1][s] + tally[2][s] + tally[3][s];

  const Lengths lengths = code_lengths(counts);
  const std::array<Code, kSymbols> codes = codes_of(lengths);
  out.put(last ? 1 : 0, 1);
  out.put(2, 2);
  put_code_table(lengths, out);
  out.flush();
  const auto put = [&](std::size_t symbol) { out.put(codes[symbol].bits, codes[symbol].length); };
  const auto put_literals = [&](std::span<const std::uint8_t> literals) {
    Bits here = out;
    std::size_t i = 0;
    for (; i + 4 <= literals.size(); i += 4) {
      for (std::size_t k = 0; k < 4; ++k) here.put(codes[literals[i + k]].bits, codes[literals[i + k]].length);
      here.flush();
    }
    for (; i < literals.size(); ++i) {
      here.put(codes[literals[i]].bits, codes[literals[i]].length);
      here.flush();
    }
    out = here;
  };
  walk(bytes, runs, put_literals, [&](std::size_t n) {
    const Length l = length_of(n);
    put(l.symbol);
    out.put(l.extra, l.extra_bits);
    out.put(0, 1);  // the distance
    out.flush();
  });
  put(kEnd);
  out.flush();
}

}  // namespace

std::vector<std::uint8_t> deflate_runs(std::span<const std::uint8_t> bytes) {
  const std::size_t blocks = bytes.size() / kBlock + 1;
  std::vector<std::uint8_t> out(bytes.size() * kLongestCode / 8 + kTable * blocks + 16);
  out[0] = 0x78;  // deflate, window of 32 KiB
  out[1] = 0x01;  // fastest; makes the head divisible by 31
  Bits bits{out.data() + 2};
  for (std::size_t b = 0; b < blocks; ++b)
    put_block(bytes.subspan(b * kBlock, std::min(kBlock, bytes.size() - b * kBlock)), b + 1 == blocks, bits);
  bits.put(0, -bits.count & 7);
  bits.flush();
  const auto sum = static_cast<std::uint32_t>(adler32_z(1, bytes.data(), bytes.size()));
  for (int i = 0; i < 4; ++i) *bits.at++ = static_cast<std::uint8_t>(sum >> (24 - 8 * i));
  out.resize(static_cast<std::size_t>(bits.at - out.data()));
  return out;
}

}  // namespace render
