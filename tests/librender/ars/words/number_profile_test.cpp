#include "librender/ars/words/number_profile.h"

#include <gtest/gtest.h>

#include "librender/ars/words/pixel_packet.h"

namespace deltaz::ars {
namespace {

TEST(NumberProfile, default_is_table_8) {
  const NumberProfile profile;
  EXPECT_TRUE(checkNumberProfile(profile).ok());
  EXPECT_TRUE(profile.fitsTriangleWords());
  EXPECT_EQ(profile.vertexFormat(), kVertexFormat);
  EXPECT_EQ(profile.dotProductFormat(), kDotProductFormat);
  EXPECT_EQ(profile.depth.bits(), kDepthBits);
  EXPECT_EQ(pixelBits(profile), kPixelPacketBits);
  // The eight words less the twelve unstated bits of the fourth.
  EXPECT_EQ(triangleBits(profile), 8 * 32 - 12);
}

TEST(NumberProfile, widths_that_go_together_change_together) {
  const NumberProfile profile;
  for (int bits = 0; bits <= kLargestVertexFractionBits; ++bits)
    EXPECT_TRUE(checkNumberProfile(withVertexFractionBits(profile, bits)).ok()) << bits;
  EXPECT_EQ(withVertexFractionBits(profile, 6), profile);
  EXPECT_EQ(withColorMantissaBits(profile, 10), profile);
  EXPECT_EQ(withPlaneMantissaBits(profile, 24), profile);
  EXPECT_EQ(withDepthMantissaBits(profile, 19), profile);
  EXPECT_FALSE(withColorMantissaBits(profile, 11).fitsTriangleWords());
  EXPECT_TRUE(withDepthMantissaBits(profile, 15).fitsTriangleWords());
  EXPECT_EQ(pixelBits(withDepthMantissaBits(profile, 15)), kPixelPacketBits - 4);
}

TEST(NumberProfile, refuses_widths_it_cannot_compute_and_says_which) {
  const NumberProfile profile;
  const auto refused = [](const NumberProfile& wrong, const char* word) {
    const Status status = checkNumberProfile(wrong);
    return !status.ok() && status.error().kind == ErrorKind::kUsage &&
           status.error().message().find(word) != std::string::npos;
  };
  EXPECT_TRUE(refused(withVertexFractionBits(profile, 13), "vertices"));
  EXPECT_TRUE(refused(withVertexFractionBits(profile, -1), "vertices"));
  EXPECT_TRUE(refused(withColorMantissaBits(profile, 26), "colours"));
  EXPECT_TRUE(refused(withPlaneMantissaBits(profile, 1), "depth planes"));
  EXPECT_TRUE(refused(withDepthMantissaBits(profile, 28), "mantissa bits of depth"));
  NumberProfile wrong = profile;
  wrong.dot_product_fraction_bits = 5;
  EXPECT_TRUE(refused(wrong, "dot products"));
  wrong = profile;
  wrong.color_accumulator_bits = 9;
  EXPECT_TRUE(refused(wrong, "accumulators"));
}

}  // namespace
}  // namespace deltaz::ars
