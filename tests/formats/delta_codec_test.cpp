#include "formats/delta_codec.h"

#include <algorithm>
#include <array>
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
  if (has_voids && *rc::gen::arbitrary<bool>()) {
    array.void_kinds =
        *rc::gen::container<std::vector<std::uint8_t>>(posts, rc::gen::inRange<std::uint8_t>(0, 3));
  }
  return array;
}

// Kinds as they come back: 0 at valid posts, and none where all are 0.
std::vector<std::uint8_t> canonicalKinds(const HeightArray& array) {
  std::vector<std::uint8_t> kinds = array.void_kinds;
  for (std::size_t k = 0; k < kinds.size(); ++k) kinds[k] = array.valid[k] == 0 ? kinds[k] : std::uint8_t{0};
  const bool all_first = std::all_of(kinds.begin(), kinds.end(), [](std::uint8_t kind) { return kind == 0; });
  return all_first ? std::vector<std::uint8_t>{} : kinds;
}

RC_GTEST_PROP(DeltaCodec, packing_reads_back_exactly, ()) {
  const HeightArray array = arbitraryArray();
  const std::vector<std::byte> bytes = packHeights(array, DeltaPacking::kPlanes);
  const Result<HeightArray> back =
      unpackHeights(bytes, DeltaPacking::kPlanes, array.columns, array.rows, "test");
  RC_ASSERT(back.ok());
  RC_ASSERT(back.value().heights == array.heights);
  RC_ASSERT(back.value().valid == array.valid);
  RC_ASSERT(back.value().void_kinds == canonicalKinds(array));
}

// The two bytes of a mask and the kinds behind it stand at the end of the frame: any other must be refused
// or give kinds of void posts only.
TEST(DeltaCodec, kinds_of_voids_cannot_stand_at_valid_posts_or_all_be_the_first) {
  HeightArray array{2, 2, {5, 5, 5, 5}, {1, 0, 1, 0}, {0, 1, 0, 2}};
  const std::vector<std::byte> bytes = packHeights(array, DeltaPacking::kPlanes);
  ASSERT_TRUE(unpackHeights(bytes, DeltaPacking::kPlanes, 2, 2, "test").ok());
  // A frame of stored (not compressed) bytes: 3 differences, the mask 0b0101, 4 kinds.
  const auto stored = [&](std::array<std::uint8_t, 4> kinds) {
    std::vector<std::byte> made(bytes.begin(), bytes.begin() + 8);
    for (const int value : {0x28, 0xB5, 0x2F, 0xFD, 0x20, 8, 8 << 3 | 1, 0, 0, 0, 0, 0, 0b0101})
      made.push_back(static_cast<std::byte>(value));
    for (const std::uint8_t kind : kinds) made.push_back(static_cast<std::byte>(kind));
    return unpackHeights(made, DeltaPacking::kPlanes, 2, 2, "test");
  };
  ASSERT_TRUE(stored({0, 1, 0, 2}).ok()) << stored({0, 1, 0, 2}).error().message();
  EXPECT_EQ(stored({0, 1, 0, 2}).value().void_kinds, array.void_kinds);
  EXPECT_FALSE(stored({1, 1, 0, 2}).ok());
  EXPECT_FALSE(stored({0, 0, 0, 0}).ok());
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
