#include "librender/ars/distribution/memory_map.h"

#include <array>
#include <gtest/gtest.h>
#include <set>
#include <string>
#include <vector>

namespace deltaz::ars {
namespace {

constexpr std::array kModes = {HashingMode::kSequential, HashingMode::kInterleave, HashingMode::kScramble};
constexpr std::array kCounts = {1, 2, 4, 8, 16, 32, 64};

std::string scrambledRow(int i) {
  const MemoryMap map(8, HashingMode::kScramble);
  std::string row;
  for (int j = 0; j < 8; ++j) row += static_cast<char>('0' + map.memory(i, j));
  return row;
}

std::size_t memoriesOfBlock(const MemoryMap& map, int i, int j, int lines, int pixels) {
  std::set<int> memories;
  for (int di = 0; di < lines; ++di)
    for (int dj = 0; dj < pixels; ++dj) memories.insert(map.memory(i + di, j + dj));
  return memories.size();
}

// Digest 7 and 15; the report's text prints row 0 (4.3.3.3).
TEST(MemoryMap, scrambles_rows_as_the_report_does) {
  EXPECT_EQ(scrambledRow(0), "03614725");
  EXPECT_EQ(scrambledRow(1), "14725036");
  // Damaged in the scan of Fig 7.
  EXPECT_EQ(scrambledRow(3), "36147250");
  EXPECT_EQ(scrambledRow(4), "47250361");
}

TEST(MemoryMap, sequential_is_eight_bands_of_64_lines) {
  const MemoryMap map(8, HashingMode::kSequential);
  for (int i = 0; i < kScreenLines; ++i) EXPECT_EQ(map.memory(i, 300), i / 64);
}

TEST(MemoryMap, interleave_goes_by_line) {
  const MemoryMap map(8, HashingMode::kInterleave);
  for (int i = 0; i < kScreenLines; ++i) EXPECT_EQ(map.memory(i, 300), i % 8);
}

// Digest 7: runs of eight across and down hit eight memories, 2 x 2 four, 2 x 4 seven.
TEST(MemoryMap, scramble_spreads_neighbours) {
  const MemoryMap map(8, HashingMode::kScramble);
  for (int i = 0; i + 8 <= 64; ++i) {
    for (int j = 0; j + 8 <= 64; ++j) {
      EXPECT_EQ(memoriesOfBlock(map, i, j, 1, 8), 8U);
      EXPECT_EQ(memoriesOfBlock(map, i, j, 8, 1), 8U);
      EXPECT_EQ(memoriesOfBlock(map, i, j, 2, 2), 4U);
      EXPECT_EQ(memoriesOfBlock(map, i, j, 2, 4), 7U);
    }
  }
}

TEST(MemoryMap, every_address_of_every_memory_is_one_place) {
  for (const HashingMode mode : kModes) {
    for (const int memories : kCounts) {
      const MemoryMap map(memories, mode);
      ASSERT_EQ(map.wordsPerMemory() * memories, kScreenLines * kScreenPixels);
      std::vector<bool> taken(static_cast<std::size_t>(kScreenLines) * kScreenPixels);
      for (int i = 0; i < kScreenLines; ++i) {
        for (int j = 0; j < kScreenPixels; ++j) {
          const int memory = map.memory(i, j), address = map.address(i, j);
          ASSERT_TRUE(memory >= 0 && memory < memories);
          ASSERT_TRUE(address >= 0 && address < map.wordsPerMemory());
          const auto word = static_cast<std::size_t>(memory * map.wordsPerMemory() + address);
          ASSERT_FALSE(taken[word]) << hashingModeName(mode) << ' ' << memories << " (" << i << ", " << j
                                    << ')';
          taken[word] = true;
          ASSERT_EQ(map.place(memory, address), (MemoryMap::Place{i, j}));
        }
      }
    }
  }
}

TEST(MemoryMap, finds_modes_by_name) {
  for (const HashingMode mode : kModes) EXPECT_EQ(hashingModeNamed(hashingModeName(mode)), mode);
  EXPECT_EQ(hashingModeNamed("scrambled"), std::nullopt);
}

}  // namespace
}  // namespace deltaz::ars
