#include "librender/ars/words/memory_depth.h"

#include <cmath>
#include <gtest/gtest.h>
#include <limits>
#include <random>

namespace deltaz::ars {
namespace {

constexpr DepthFormat kWritten{.leading_one = LeadingOne::kWritten};

TEST(MemoryDepth, has_five_bits_of_exponent_above_nineteen_of_mantissa) {
  constexpr DepthFormat kFormat;
  static_assert(kFormat.bits() == 24);
  EXPECT_EQ(kFormat.encode(1, Rounding::kNearest), 31u << 19);
  EXPECT_EQ(kFormat.encode(1.5, Rounding::kNearest), 31u << 19 | 1u << 18);
  EXPECT_EQ(kFormat.encode(0.25, Rounding::kNearest), 29u << 19);
  EXPECT_EQ(kWritten.encode(1, Rounding::kNearest), 31u << 19 | 1u << 18);
}

TEST(MemoryDepth, every_word_comes_back_and_words_are_ordered_as_depths) {
  for (const DepthFormat& format : {DepthFormat{}, kWritten}) {
    double before = -1;
    for (std::uint32_t word = 0; word <= format.largestWord(); ++word) {
      const std::uint32_t leading = 1u << (format.mantissa_bits - 1);
      if (format.leading_one == LeadingOne::kWritten && word != 0 && (word & leading) == 0) continue;
      const double depth = format.decode(word);
      ASSERT_GT(depth, before);
      ASSERT_EQ(format.encode(depth, Rounding::kNearest), word);
      ASSERT_EQ(format.encode(depth, Rounding::kTruncate), word);
      before = depth;
    }
  }
}

TEST(MemoryDepth, rounds_and_truncates_between_words) {
  constexpr DepthFormat kFormat;
  std::mt19937 random(3);
  for (int i = 0; i < 200000; ++i) {
    const std::uint32_t word = 1 + static_cast<std::uint32_t>(random() % (kFormat.largestWord() - 1));
    const double low = kFormat.decode(word), high = kFormat.decode(word + 1);
    EXPECT_EQ(kFormat.encode(low + 0.49 * (high - low), Rounding::kNearest), word);
    EXPECT_EQ(kFormat.encode(low + 0.51 * (high - low), Rounding::kNearest), word + 1);
    EXPECT_EQ(kFormat.encode(low + 0.99 * (high - low), Rounding::kTruncate), word);
    const std::uint32_t tie = kFormat.encode(low + 0.5 * (high - low), Rounding::kNearest);
    EXPECT_EQ(tie, word % 2 == 0 ? word : word + 1);
  }
}

TEST(MemoryDepth, every_value_is_defined) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  constexpr DepthFormat kFormat;
  for (const Rounding rounding : {Rounding::kNearest, Rounding::kTruncate}) {
    for (const double depth : {0.0, -0.0, -1.0, -kInfinity, 1e-300, std::numeric_limits<double>::quiet_NaN()})
      EXPECT_EQ(kFormat.encode(depth, rounding), 0u);
    for (const double depth : {2.0, 1e300, kInfinity}) EXPECT_EQ(kFormat.encode(depth, rounding), 0xFFFFFFu);
  }
  EXPECT_EQ(kFormat.encode(std::nextafter(2.0, 0), Rounding::kNearest), 0xFFFFFFu);
  EXPECT_EQ(kFormat.encode(std::nextafter(powerOfTwo(-31), 0), Rounding::kTruncate), 0u);
}

// Digest section 1, Table 2: 1/U in floating point resolves U 2^-(M+1), 9.5 mm at 10 km.
TEST(MemoryDepth, resolves_depth_as_table_2_says) {
  constexpr DepthFormat kFormat{.exponent_bias = depthBiasForHither(1)};
  std::mt19937_64 random(4);
  double worst = 0;
  for (int i = 0; i < 100000; ++i) {
    const double u = 10000.0 + static_cast<double>(random() % 1000000) * 1e-1;
    const double back = 1 / kFormat.decode(kFormat.encode(1 / u, Rounding::kNearest));
    worst = std::max(worst, std::abs(back - u) / u);
  }
  EXPECT_LE(worst, powerOfTwo(-20) * 1.00001);
  EXPECT_GE(worst, powerOfTwo(-20) * 0.99);
}

TEST(MemoryDepth, bias_puts_the_hither_plane_into_the_top_octave) {
  for (const double hither : {0.01, 0.3, 1.0, 1.5, 7.0, 100.0}) {
    const DepthFormat format{.exponent_bias = depthBiasForHither(hither)};
    EXPECT_EQ(format.encode(1 / hither, Rounding::kTruncate) >> 19, 31u) << hither;
  }
  EXPECT_EQ(depthBiasForHither(1), 31);
}

}  // namespace
}  // namespace deltaz::ars
