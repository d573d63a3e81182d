#include "formats/delta_codec.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "formats/terrain_segment.h"

namespace deltaz {
namespace {

// The digest's example: z = (100, 103; 98, 105) for SW, SE; NW, NE gives dz (100, 3; -2, 7).
TEST(DeltaCodec, differences_are_those_of_the_report) {
  const std::vector<std::int32_t> heights = {100, 103, 98, 105};
  const std::vector<std::int32_t> expected = {100, 3, -2, 7};
  EXPECT_EQ(differencesOf(heights, 2, 2), expected);
  EXPECT_EQ(sumsOf(expected, 2, 2), heights);
}

HeightArray arbitraryArray() {
  HeightArray array;
  array.columns = *rc::gen::inRange<std::uint32_t>(1, 20);
  array.rows = *rc::gen::inRange<std::uint32_t>(1, 20);
  const std::size_t posts = static_cast<std::size_t>(array.columns) * array.rows;
  const std::int32_t range = *rc::gen::element(1, 100, 30000, kMaximumHeightQuanta);
  array.heights = *rc::gen::container<std::vector<std::int32_t>>(
      posts, rc::gen::inRange<std::int32_t>(-range, range + 1));
  const bool has_voids = *rc::gen::arbitrary<bool>();
  array.valid.assign(posts, 1);
  if (has_voids)
    array.valid = *rc::gen::container<std::vector<std::uint8_t>>(posts, rc::gen::element<std::uint8_t>(0, 1));
  fillVoids(array);
  return array;
}

RC_GTEST_PROP(DeltaCodec, packing_reads_back_exactly, ()) {
  const HeightArray array = arbitraryArray();
  const std::vector<std::byte> bytes = packHeights(array, DeltaPacking::kPlanes);
  const Result<HeightArray> back =
      unpackHeights(bytes, DeltaPacking::kPlanes, array.columns, array.rows, "test");
  RC_ASSERT(back.ok());
  RC_ASSERT(back.value().heights == array.heights);
  RC_ASSERT(back.value().valid == array.valid);
}

RC_GTEST_PROP(DeltaCodec, every_prefix_is_refused, ()) {
  const HeightArray array = arbitraryArray();
  const std::vector<std::byte> bytes = packHeights(array, DeltaPacking::kPlanes);
  const auto length = *rc::gen::inRange<std::size_t>(0, bytes.size());
  RC_ASSERT(
      !unpackHeights(std::span(bytes).first(length), DeltaPacking::kPlanes, array.columns, array.rows, "test")
           .ok());
}

TEST(DeltaCodec, voids_cost_no_differences) {
  HeightArray array{4, 2, {0, 7, 0, 9, 0, 0, 0, 8}, {0, 1, 0, 1, 0, 0, 0, 1}};
  fillVoids(array);
  EXPECT_EQ(array.heights, (std::vector<std::int32_t>{7, 7, 7, 9, 7, 7, 7, 8}));
}

TEST(DeltaCodec, differences_at_the_integer_limits_read_back) {
  const std::int32_t top = kMaximumHeightQuanta;
  const HeightArray array{3, 2, {top, -top, top, -top, top, -top}, {1, 1, 1, 1, 1, 1}};
  const Result<HeightArray> back =
      unpackHeights(packHeights(array, DeltaPacking::kPlanes), DeltaPacking::kPlanes, 3, 2, "test");
  ASSERT_TRUE(back.ok());
  EXPECT_EQ(back.value().heights, array.heights);
}

// Ten thousand posts of one row: the sum is exact, where adding floats drifts.
TEST(DeltaCodec, long_rows_do_not_drift) {
  std::vector<std::int32_t> heights(10000);
  for (std::size_t i = 0; i < heights.size(); ++i)
    heights[i] = static_cast<std::int32_t>((i * 2654435761u) % 9000);
  EXPECT_EQ(sumsOf(differencesOf(heights, 10000, 1), 10000, 1), heights);
}

}  // namespace
}  // namespace deltaz
