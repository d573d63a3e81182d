#include "libdb/access/color.h"

#include <cmath>
#include <gtest/gtest.h>
#include <limits>

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

}  // namespace
}  // namespace deltaz
