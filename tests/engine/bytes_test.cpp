// What is read back from bytes is what was written, or it is refused.
#include "engine/bytes.h"

#include <gtest/gtest.h>

namespace engine {
namespace {

struct Flags {
  bool first = false, second = false;
  std::vector<std::uint16_t> list;

  template <class S>
  static auto fields(S& s) {
    return std::tie(s.first, s.second, s.list);
  }
};

TEST(Bytes, GiveBackWhatWasWritten) {
  ByteWriter out;
  out.put(Flags{true, false, {1, 2, 65535}});
  ByteReader in(out.bytes);
  Flags read;
  in.get(read);
  EXPECT_TRUE(in.at_end());
  EXPECT_TRUE(read.first);
  EXPECT_FALSE(read.second);
  EXPECT_EQ(read.list, (std::vector<std::uint16_t>{1, 2, 65535}));
}

TEST(Bytes, HoldNoFlagBetweenYesAndNo) {
  ByteWriter out;
  out.put(Flags{true, false, {}});
  out.bytes[1] = 2;
  ByteReader in(out.bytes);
  Flags read;
  in.get(read);
  EXPECT_FALSE(in.good);
  EXPECT_TRUE(read.first);
  EXPECT_FALSE(read.second);
}

TEST(Bytes, OfAListLongerThanTheyAreAskForNoMemory) {
  ByteWriter out;
  out.put(std::uint64_t{1} << 60);
  ByteReader in(out.bytes);
  std::vector<double> list;
  in.get(list);
  EXPECT_FALSE(in.good);
  EXPECT_TRUE(list.empty());
}

}  // namespace
}  // namespace engine
