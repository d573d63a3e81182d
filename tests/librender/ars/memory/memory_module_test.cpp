#include "librender/ars/memory/memory_module.h"

#include <gtest/gtest.h>
#include <vector>

namespace deltaz::ars {
namespace {

// A module with words of its own.
struct Words {
  explicit Words(std::size_t count) : store(count) {}
  std::vector<std::uint64_t> store;
};
class OwnModule : private Words, public MemoryModule {
 public:
  explicit OwnModule(std::size_t words, TieRule ties = TieRule::kFirstStays)
      : Words(words), MemoryModule(store, ties) {}
};

constexpr std::uint32_t depthOf(std::uint32_t exponent, std::uint32_t mantissa) {
  return exponent << kDepthMantissaBits | mantissa;
}

MemoryCycle put(MemoryModule& memory, std::uint32_t depth, std::uint8_t color, bool background = false) {
  return memory.write(0, memoryWord(depth, color), background);
}

TEST(MemoryModule, has_words_of_33_bits) {
  EXPECT_EQ(kMemoryWordBits, 33);
}

// Digest 15: one pixel written BG, foreground, nearer by an octave, farther by an octave, in the same octave
// nearer and farther, read: 115 + 165 + 190 + 150 + 210 + 170 + 240 ns.
TEST(MemoryModule, goes_through_all_cycles_in_1240_nanoseconds) {
  OwnModule memory(1);
  const std::vector<MemoryCycle> cycles = {
      put(memory, depthOf(31, 0), 1, true), put(memory, depthOf(10, 5), 2), put(memory, depthOf(11, 5), 3),
      put(memory, depthOf(10, 9), 4),       put(memory, depthOf(11, 7), 5), put(memory, depthOf(11, 6), 6)};
  EXPECT_EQ(cycles, (std::vector{MemoryCycle::kBackground, MemoryCycle::kInitialize,
                                 MemoryCycle::kLookAheadWrite, MemoryCycle::kLookAheadNoWrite,
                                 MemoryCycle::kReadCompareWrite, MemoryCycle::kReadCompareNoWrite}));
  EXPECT_EQ(memory.read(0), 5);

  const CycleLengths lengths = cycleLengths(MemoryDesign::kVariable);
  std::int64_t nanoseconds = 0;
  for (std::size_t k = 0; k < kMemoryCycleCount; ++k) {
    EXPECT_EQ(memory.counts().cycles[k], 1);
    nanoseconds += memory.counts().cycles[k] * lengths.nanoseconds[k];
  }
  EXPECT_EQ(nanoseconds, 1240);
}

TEST(MemoryModule, background_leaves_the_init_flag) {
  OwnModule memory(1);
  put(memory, depthOf(31, 0), 1, true);
  EXPECT_FALSE(memory.initialized(0));
  EXPECT_EQ(put(memory, 0, 2), MemoryCycle::kInitialize);  // however far
  EXPECT_EQ(memory.color(0), 2);
  put(memory, 0, 3, true);
  EXPECT_TRUE(memory.initialized(0));
  EXPECT_EQ(memory.color(0), 3);
}

// Digest 8 (a): overlays must come last.
TEST(MemoryModule, foreground_overwrites_what_background_alone_wrote) {
  OwnModule memory(1);
  put(memory, depthOf(31, 99), 1, true);
  put(memory, depthOf(1, 0), 2);
  EXPECT_EQ(memory.color(0), 2);
}

// Digest 8 (b).
TEST(MemoryModule, read_clears_the_flag_and_not_the_color) {
  OwnModule memory(1);
  put(memory, depthOf(20, 0), 7);
  EXPECT_EQ(memory.read(0), 7);
  EXPECT_FALSE(memory.initialized(0));
  EXPECT_EQ(memory.read(0), 7);  // the picture before
  EXPECT_EQ(put(memory, depthOf(1, 0), 8), MemoryCycle::kInitialize);
}

// Digest 8 (e).
TEST(MemoryModule, of_equal_depths_the_first_stays) {
  OwnModule memory(1);
  put(memory, depthOf(4, 4), 9);
  EXPECT_EQ(put(memory, depthOf(4, 4), 200), MemoryCycle::kReadCompareNoWrite);
  EXPECT_EQ(memory.color(0), 9);
  EXPECT_EQ(put(memory, depthOf(4, 4), 9), MemoryCycle::kReadCompareNoWrite);
  EXPECT_EQ(memory.counts().ties, 2);
  EXPECT_EQ(memory.counts().split_ties, 1);
}

TEST(MemoryModule, brighter_rule_makes_ties_independent_of_order) {
  OwnModule one(1, TieRule::kBrighter), other(1, TieRule::kBrighter);
  put(one, depthOf(4, 4), 9);
  EXPECT_EQ(put(one, depthOf(4, 4), 200), MemoryCycle::kReadCompareWrite);
  put(other, depthOf(4, 4), 200);
  EXPECT_EQ(put(other, depthOf(4, 4), 9), MemoryCycle::kReadCompareNoWrite);
  EXPECT_EQ(one.color(0), 200);
  EXPECT_EQ(other.color(0), 200);
}

// 32 exponents, not five regions as 4.1.3 has it.
TEST(MemoryModule, decides_by_exponent_in_all_32_octaves) {
  for (std::uint32_t held = 0; held < 32; ++held) {
    for (std::uint32_t comes = 0; comes < 32; ++comes) {
      OwnModule memory(1);
      put(memory, depthOf(held, 0x40000), 1);
      const MemoryCycle cycle = put(memory, depthOf(comes, 0x40000), 2);
      EXPECT_EQ(cycle, comes > held   ? MemoryCycle::kLookAheadWrite
                       : comes < held ? MemoryCycle::kLookAheadNoWrite
                                      : MemoryCycle::kReadCompareNoWrite);
      EXPECT_EQ(memory.color(0), comes > held ? 2 : 1);
    }
  }
}

// For studies of other formats of depth.
TEST(MemoryModule, compares_depths_of_32_bits_with_mantissas_of_any_width) {
  std::vector<std::uint64_t> store(1);
  MemoryModule memory(store, TieRule::kFirstStays, 27);
  memory.write(0, memoryWord(0xF7FFFFFF, 1), false);
  EXPECT_EQ(memory.write(0, memoryWord(0xF8000000, 2), false), MemoryCycle::kLookAheadWrite);
  EXPECT_EQ(memory.write(0, memoryWord(0xFFFFFFFF, 3), false), MemoryCycle::kReadCompareWrite);
  EXPECT_EQ(memory.depth(0), 0xFFFFFFFF);
  EXPECT_EQ(memory.read(0), 3);
  EXPECT_EQ(memory.depth(0), 0xFFFFFFFF);
}

TEST(MemoryModule, keeps_words_apart) {
  OwnModule memory(3);
  memory.write(1, memoryWord(0xFFFFFF, 0xFF), false);
  EXPECT_EQ(memory.depth(1), 0xFFFFFFU);
  for (const std::uint32_t other : {0U, 2U}) {
    EXPECT_EQ(memory.depth(other), 0U);
    EXPECT_EQ(memory.color(other), 0);
    EXPECT_FALSE(memory.initialized(other));
  }
}

}  // namespace
}  // namespace deltaz::ars
