#include "librender/ars/words/fixed_point.h"

#include <gtest/gtest.h>
#include <limits>

namespace deltaz::ars {
namespace {

// Digest section 15: fixed -512..511.984375.
TEST(FixedPoint, has_the_range_of_table_8) {
  static_assert(kVertexFormat.bits() == 16 && kDotProductFormat.bits() == 28);
  EXPECT_EQ(kVertexFormat.value(kVertexFormat.least()), -512);
  EXPECT_EQ(kVertexFormat.value(kVertexFormat.largest()), 511.984375);
  EXPECT_EQ(kDotProductFormat.value(kDotProductFormat.least()), -524288);
  EXPECT_EQ(kDotProductFormat.value(1), 1.0 / 256);
}

TEST(FixedPoint, words_of_sixteen_bits_come_back) {
  for (const SignForm sign : {SignForm::kTwosComplement, SignForm::kSignMagnitude}) {
    const FixedPointFormat format{.integer_bits = 9, .fraction_bits = 6, .sign = sign};
    for (std::uint64_t word = 0; word < 0x10000; ++word) {
      const std::int64_t raw = format.decode(word);
      EXPECT_GE(raw, format.least());
      EXPECT_LE(raw, format.largest());
      const bool minus_zero = sign == SignForm::kSignMagnitude && word == 0x8000;
      EXPECT_EQ(format.encode(raw), minus_zero ? 0 : word);
      EXPECT_EQ(format.nearest(format.value(raw)), raw);
    }
  }
}

TEST(FixedPoint, takes_the_nearest_and_of_two_the_greater) {
  for (std::int64_t raw = -1000; raw <= 1000; ++raw) {
    const double lsb = kVertexFormat.value(1), x = kVertexFormat.value(raw);
    EXPECT_EQ(kVertexFormat.nearest(x + 0.499 * lsb), raw);
    EXPECT_EQ(kVertexFormat.nearest(x + 0.5 * lsb), raw + 1);
    EXPECT_EQ(kVertexFormat.nearest(x - 0.5 * lsb), raw);
  }
  // Where adding one half would round up.
  EXPECT_EQ(kVertexFormat.nearest(0.49999999999999994 / 64), 0);
}

TEST(FixedPoint, saturates_and_reads_no_number_as_zero) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  EXPECT_EQ(kVertexFormat.nearest(512), 32767);
  EXPECT_EQ(kVertexFormat.nearest(-513), -32768);
  EXPECT_EQ(kVertexFormat.nearest(kInfinity), 32767);
  EXPECT_EQ(kVertexFormat.nearest(-kInfinity), -32768);
  EXPECT_EQ(kVertexFormat.nearest(std::numeric_limits<double>::quiet_NaN()), 0);
  const FixedPointFormat magnitude{.integer_bits = 9, .fraction_bits = 6, .sign = SignForm::kSignMagnitude};
  EXPECT_EQ(magnitude.nearest(-513), -32767);
}

TEST(FixedPoint, pixels_are_the_nearest_and_of_two_the_greater) {
  EXPECT_EQ(nearestPixel(31, 6), 0);
  EXPECT_EQ(nearestPixel(32, 6), 1);
  EXPECT_EQ(nearestPixel(-32, 6), 0);
  EXPECT_EQ(nearestPixel(-33, 6), -1);
  EXPECT_EQ(nearestPixel(511 * 64 + 31, 6), 511);
  EXPECT_EQ(nearestPixel(77, 0), 77);
}

}  // namespace
}  // namespace deltaz::ars
