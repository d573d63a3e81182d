#include "librender/ars/memory/memory_channel.h"

#include <gtest/gtest.h>
#include <vector>

namespace deltaz::ars {
namespace {

constexpr CycleLengths kLengths = {{115, 165, 150, 190, 170, 210, 240}};

TEST(MemoryChannel, serves_a_pixel_when_it_comes_and_the_next_when_that_is_done) {
  std::vector<std::uint64_t> words(4);
  MemoryModule module(words);
  MemoryChannel channel(module, kLengths);
  channel.accept(0, memoryWord(1, 1), false, 1000 * kNanosecond);
  EXPECT_EQ(channel.idleAt(), 1165 * kNanosecond);
  channel.accept(1, memoryWord(1, 1), true, 1100 * kNanosecond);
  EXPECT_EQ(channel.idleAt(), 1280 * kNanosecond);
  channel.accept(2, memoryWord(1, 1), false, 1300 * kNanosecond);
  EXPECT_EQ(channel.idleAt(), 1465 * kNanosecond);

  const MemoryChannelStatistics statistics = channel.statistics(1500 * kNanosecond);
  EXPECT_EQ(statistics.busy, (165 + 115 + 165) * kNanosecond);
  EXPECT_EQ(statistics.starved, (1000 + 20 + 35) * kNanosecond);
  EXPECT_EQ(statistics.busy + statistics.starved, 1500 * kNanosecond);
}

TEST(MemoryChannel, has_room_again_when_a_waiting_pixels_cycle_begins) {
  std::vector<std::uint64_t> words(8);
  MemoryModule module(words);
  MemoryChannel channel(module, kLengths, 2);
  channel.accept(0, memoryWord(1, 1), false, 0);  // in its cycle at once: it waits in no FIFO
  channel.accept(1, memoryWord(1, 1), false, 0);
  ASSERT_TRUE(channel.hasRoom(0));
  channel.accept(2, memoryWord(1, 1), false, 0);
  EXPECT_FALSE(channel.hasRoom(0));
  EXPECT_FALSE(channel.hasRoom(165 * kNanosecond - 1));
  EXPECT_TRUE(channel.hasRoom(165 * kNanosecond));
  EXPECT_EQ(channel.statistics(kMicrosecond).high_water, 2);
}

}  // namespace
}  // namespace deltaz::ars
