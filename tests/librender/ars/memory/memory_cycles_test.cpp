#include "librender/ars/memory/memory_cycles.h"

#include <cmath>
#include <gtest/gtest.h>

namespace deltaz::ars {
namespace {

// Report Table 20, totals of its columns; the digest (8) gives the average that they make.
constexpr CycleCounts kTable20 = {0, 156964, 31765, 25499, 15265, 14114, 0};

double rounded(double value, double digits) {
  return std::round(value * digits) / digits;
}

// Digest 8 and 15.
TEST(MemoryCycles, table_20_averages_168_58_nanoseconds) {
  const double average = averageCycle(kTable20, cycleLengths(MemoryDesign::kVariable));
  EXPECT_EQ(rounded(average, 100), 168.58);
  EXPECT_EQ(rounded(1000 / average, 100), 5.93);     // million pixels a second and module
  EXPECT_EQ(rounded(8 * 1000 / average, 10), 47.5);  // and eight modules
}

TEST(MemoryCycles, variable_lengths_save_19_7_percent) {
  const double average = averageCycle(kTable20, cycleLengths(MemoryDesign::kVariable));
  const double fixed = averageCycle(kTable20, cycleLengths(MemoryDesign::kFixed));
  EXPECT_EQ(fixed, 210);
  EXPECT_EQ(rounded(100 * (1 - average / fixed), 10), 19.7);
}

// Digest 8: what Fig 85 shows as curves, at Table 20's counts.
TEST(MemoryCycles, simpler_designs_take_176_3_and_181_0_nanoseconds) {
  EXPECT_EQ(rounded(averageCycle(kTable20, cycleLengths(MemoryDesign::kNoEarlyEnd)), 10), 176.3);
  EXPECT_EQ(rounded(averageCycle(kTable20, cycleLengths(MemoryDesign::kNoLookAhead)), 10), 181.0);
}

TEST(MemoryCycles, average_of_nothing_is_nothing) {
  EXPECT_EQ(averageCycle({}, cycleLengths(MemoryDesign::kVariable)), 0);
}

TEST(MemoryCycles, finds_designs_by_name) {
  for (const MemoryDesign design : kMemoryDesigns)
    EXPECT_EQ(memoryDesignNamed(memoryDesignName(design)), design);
  EXPECT_EQ(memoryDesignNamed(""), std::nullopt);
}

}  // namespace
}  // namespace deltaz::ars
