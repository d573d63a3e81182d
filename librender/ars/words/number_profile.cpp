#include "librender/ars/words/number_profile.h"

#include <algorithm>
#include <fmt/format.h>

#include "librender/ars/words/pixel_packet.h"

namespace deltaz::ars {

namespace {

constexpr const char* kWhere = "number formats";

Status checkRange(const char* what, int value, int least, int largest) {
  if (value >= least && value <= largest) return Success{};
  return usageError(kWhere, fmt::format("{} cannot be {}", what, value), {},
                    fmt::format("Choose from {} to {}", least, largest));
}

Status checkFloat(const char* what, const FloatFormat& format) {
  DELTAZ_TRY(checkRange(fmt::format("exponent bits of {}", what).c_str(), format.exponent_bits, 1,
                        kLargestExponentBits));
  const int hidden = format.hidden() ? 1 : 0;
  return checkRange(fmt::format("mantissa bits of {}", what).c_str(), format.mantissa_bits, 2,
                    std::min(kLargestPrecision - hidden, 30 - format.exponent_bits));
}

const char* name(SignForm form) {
  return form == SignForm::kSignMagnitude ? "sign and magnitude" : "two's complement";
}
const char* name(LeadingOne form) {
  return form == LeadingOne::kWritten ? "leading one written" : "leading one hidden";
}
const char* name(Rounding rounding) {
  return rounding == Rounding::kNearest ? "rounded to nearest" : "truncated";
}

std::string describe(const char* what, const FloatFormat& format) {
  return fmt::format("{} {}+{} bits, exponent in {}, mantissa in {}, {}", what, format.exponent_bits,
                     format.mantissa_bits, name(format.exponent_sign), name(format.mantissa_sign),
                     name(format.leading_one));
}

}  // namespace

bool NumberProfile::fitsTriangleWords() const {
  return vertex_fraction_bits == kVertexFormat.fraction_bits &&
         color.exponent_bits == kColorFormat.exponent_bits &&
         color.mantissa_bits == kColorFormat.mantissa_bits &&
         depth_plane.exponent_bits == kDepthPlaneFormat.exponent_bits &&
         depth_plane.mantissa_bits == kDepthPlaneFormat.mantissa_bits;
}

NumberProfile withVertexFractionBits(NumberProfile profile, int bits) {
  profile.vertex_fraction_bits = bits;
  // No more than P needs: twice the vertices' and the one of the undersample tolerance.
  profile.dot_product_fraction_bits = std::min(bits + 2, 2 * bits + 1);
  return profile;
}

NumberProfile withColorMantissaBits(NumberProfile profile, int bits) {
  profile.color.mantissa_bits = bits;
  profile.color_accumulator_bits = profile.color.precision() + kStepBits;
  return profile;
}

NumberProfile withPlaneMantissaBits(NumberProfile profile, int bits) {
  profile.depth_plane.mantissa_bits = bits;
  profile.depth_accumulator_bits = profile.depth_plane.precision() + kStepBits;
  return profile;
}

NumberProfile withDepthMantissaBits(NumberProfile profile, int bits) {
  profile.depth.mantissa_bits = bits;
  return profile;
}

int triangleBits(const NumberProfile& profile) {
  constexpr int kFlagBits = 4;  // BG, over or under, corner
  return 6 * profile.vertexFormat().bits() + 3 * profile.color.bits() + 3 * profile.depth_plane.bits() +
         kFlagBits;
}

int pixelBits(const NumberProfile& profile) {
  return kAddressBits + profile.depth.bits() + kColorBits + 1;
}

Status checkNumberProfile(const NumberProfile& profile) {
  DELTAZ_TRY(
      checkRange("fraction bits of vertices", profile.vertex_fraction_bits, 0, kLargestVertexFractionBits));
  DELTAZ_TRY(checkRange("fraction bits of dot products", profile.dot_product_fraction_bits,
                        profile.vertex_fraction_bits, 2 * profile.vertex_fraction_bits + 1));
  DELTAZ_TRY(checkFloat("colours", profile.color));
  DELTAZ_TRY(checkFloat("depth planes", profile.depth_plane));
  DELTAZ_TRY(checkRange("exponent bits of depth", profile.depth.exponent_bits, 1, kLargestExponentBits));
  DELTAZ_TRY(checkRange("mantissa bits of depth", profile.depth.mantissa_bits, 2,
                        std::min(27, 32 - profile.depth.exponent_bits)));
  DELTAZ_TRY(checkRange("the exponent bias of depth", profile.depth.exponent_bias, -256, 512));
  DELTAZ_TRY(checkRange("bits of colour accumulators", profile.color_accumulator_bits, kStepBits + 1, 52));
  return checkRange("bits of depth accumulators", profile.depth_accumulator_bits, kStepBits + 1, 52);
}

std::string describe(const NumberProfile& profile) {
  return fmt::format(
      "vertices 9+{} bits, dot products 19+{} bits in {}; {}; {}; memory depth {}+{} bits, {}, bias {}; "
      "accumulators {} and {} bits; "
      "arithmetic {}, output {}",
      profile.vertex_fraction_bits, profile.dot_product_fraction_bits, name(profile.fixed_point_sign),
      describe("colour", profile.color), describe("depth plane", profile.depth_plane),
      profile.depth.exponent_bits, profile.depth.mantissa_bits, name(profile.depth.leading_one),
      profile.depth.exponent_bias, profile.color_accumulator_bits, profile.depth_accumulator_bits,
      name(profile.arithmetic), name(profile.output));
}

}  // namespace deltaz::ars
