// Delta-z arrays at the limits of their integers: prefix sums are exact whatever the length and the steps.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <gtest/gtest.h>
#include <limits>

#include "formats/delta_codec.h"
#include "formats/terrain_segment.h"
#include "tests/stress/bound_check.h"

namespace deltaz {
namespace {

std::vector<std::int32_t> alternating(std::size_t columns, std::size_t rows) {
  std::vector<std::int32_t> heights(columns * rows);
  for (std::size_t k = 0; k < heights.size(); ++k)
    heights[k] = (k / columns + k % columns) % 2 == 0 ? kMaximumHeightQuanta : -kMaximumHeightQuanta;
  return heights;
}

// How many posts of `b` are not those of `a`.
double differing(const std::vector<std::int32_t>& a, const std::vector<std::int32_t>& b) {
  if (a.size() != b.size()) return std::numeric_limits<double>::infinity();
  double count = 0;
  for (std::size_t k = 0; k < a.size(); ++k) count += a[k] != b[k] ? 1 : 0;
  return count;
}

TEST(CodecLimits, differences_of_two_to_the_31_come_back) {
  const std::vector<std::int32_t> heights = alternating(65, 65);
  const std::vector<std::int32_t> differences = differencesOf(heights, 65, 65);
  EXPECT_EQ(*std::min_element(differences.begin(), differences.end()),
            std::numeric_limits<std::int32_t>::min());
  expectWithin("posts changed by differences of 2^31", differing(heights, sumsOf(differences, 65, 65)), 0);
}

TEST(CodecLimits, sums_along_ten_thousand_posts_are_exact) {
  // Ramps to the limit and back, and noise on top: 10,000 sums in a row and in a column.
  for (const auto& [columns, rows] : {std::pair<std::uint32_t, std::uint32_t>{10000, 3}, {3, 10000}}) {
    std::vector<std::int32_t> heights(std::size_t{columns} * rows);
    std::uint32_t noise = 1;
    for (std::size_t k = 0; k < heights.size(); ++k) {
      noise = noise * 1664525u + 1013904223u;
      const std::int64_t ramp =
          static_cast<std::int64_t>(k) * 200003 % (2LL * kMaximumHeightQuanta) - kMaximumHeightQuanta;
      heights[k] = static_cast<std::int32_t>(std::clamp<std::int64_t>(
          ramp + static_cast<std::int32_t>(noise >> 8), -kMaximumHeightQuanta, kMaximumHeightQuanta));
    }
    expectWithin("posts changed in an array of " + std::to_string(columns) + " x " + std::to_string(rows),
                 differing(heights, sumsOf(differencesOf(heights, columns, rows), columns, rows)), 0);
  }
}

// What a float would have made of the same sums: the reason they are integers.
TEST(CodecLimits, floats_would_have_drifted) {
  constexpr std::size_t kPosts = 10000;
  std::vector<std::int32_t> heights(kPosts);
  for (std::size_t k = 0; k < kPosts; ++k)
    heights[k] = static_cast<std::int32_t>(std::lround(500 * std::sin(static_cast<double>(k) * 0.01))) + 3;
  const float quantum = 0.3048F;
  float sum = static_cast<float>(heights[0]) * quantum;
  double drift = 0;
  for (std::size_t k = 1; k < kPosts; ++k) {
    sum += static_cast<float>(heights[k] - heights[k - 1]) * quantum;
    drift = std::max(drift, std::abs(static_cast<double>(sum) - heights[k] * 0.3048));
  }
  std::printf("10,000 posts of feet summed in float drift by %.4g m\n", drift);
  EXPECT_GT(drift, 1e-4);
}

TEST(CodecLimits, a_block_of_alternating_limits_comes_back) {
  for (const bool voids : {false, true}) {
    TerrainBlock block;
    block.columns = block.rows = 65;
    block.spacing_x = block.spacing_y = 1.0 / 3600;
    block.heights = alternating(67, 67);
    block.valid.assign(67 * 67, 1);
    if (voids) {
      for (std::size_t k = 0; k < block.valid.size(); k += 3) block.valid[k] = 0;
    }
    block.ancestors = {{std::numeric_limits<std::uint32_t>::max(), std::numeric_limits<std::uint64_t>::max(),
                        std::numeric_limits<std::uint32_t>::max()}};
    const std::vector<std::byte> bytes = encodeTerrainBlock(block);
    const Result<TerrainBlock> decoded = decodeTerrainBlock(bytes, 64, "block");
    ASSERT_TRUE(decoded.ok()) << decoded.error().message();
    double changed = 0;
    for (std::size_t k = 0; k < block.heights.size(); ++k) {
      if (block.valid[k] != 0) changed += decoded.value().heights[k] != block.heights[k] ? 1 : 0;
    }
    expectWithin(std::string("valid posts changed, ") + (voids ? "every third void" : "no voids"), changed,
                 0);
    EXPECT_EQ(decoded.value().valid, block.valid);
    EXPECT_EQ(decoded.value().ancestors, block.ancestors);
    EXPECT_EQ(encodeTerrainBlock(decoded.value()), encodeTerrainBlock(block));
  }
}

}  // namespace
}  // namespace deltaz
