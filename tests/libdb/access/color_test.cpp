#include "libdb/access/color.h"

#include <cmath>
#include <gtest/gtest.h>
#include <limits>
#include <vector>

#include "libdb/access/simd_target.h"

namespace deltaz {
namespace {

TEST(Color, every_srgb_code_survives_decoding_and_encoding) {
  for (int code = 0; code < 256; ++code) {
    EXPECT_EQ(encodeSrgb(decodeSrgb(static_cast<std::uint8_t>(code))), code);
  }
}

TEST(Color, encoding_is_the_nearest_code_of_the_standard_curve) {
  for (int step = 0; step <= 100000; ++step) {
    const double linear = step / 100000.0;
    const double encoded = linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1 / 2.4) - 0.055;
    EXPECT_NEAR(encodeSrgb(linear), encoded * 255, 0.5 + 1e-3) << linear;
  }
}

TEST(Color, encoding_clamps_what_is_no_colour) {
  EXPECT_EQ(encodeSrgb(-0.1), 0);
  EXPECT_EQ(encodeSrgb(7), 255);
  EXPECT_EQ(encodeSrgb(std::numeric_limits<double>::infinity()), 255);
  EXPECT_EQ(encodeSrgb(std::numeric_limits<double>::quiet_NaN()), 0);
}

TEST(Color, lists_are_encoded_as_single_values_are_on_every_vector_width) {
  std::vector<double> red, green, blue;
  for (int n = 0; n < 777; ++n) {
    red.push_back(n / 700.0 - 0.05);
    green.push_back(std::pow(n / 776.0, 3));
    blue.push_back(n % 5 == 0 ? std::numeric_limits<double>::quiet_NaN() : 1.0 / (n + 1));
  }
  blue[7] = std::numeric_limits<double>::infinity();
  for (const SimdTarget target : simdTargets()) {
    ASSERT_TRUE(limitSimdTarget(target));
    for (const std::size_t count : {std::size_t{0}, std::size_t{1}, std::size_t{65}, red.size()}) {
      std::vector<std::uint8_t> codes(3 * count + 1, 99);
      encodeSrgb(red.data(), green.data(), blue.data(), count, codes.data());
      for (std::size_t n = 0; n < count; ++n) {
        ASSERT_EQ(codes[3 * n], encodeSrgb(red[n]));
        ASSERT_EQ(codes[3 * n + 1], encodeSrgb(green[n]));
        ASSERT_EQ(codes[3 * n + 2], encodeSrgb(blue[n]));
      }
      EXPECT_EQ(codes.back(), 99);
    }
  }
  limitSimdTarget(std::nullopt);
}

}  // namespace
}  // namespace deltaz
