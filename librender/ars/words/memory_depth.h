// The depth a memory holds (report Table 8, 4.1): an exponent above a mantissa, unsigned, so that words
// compare as the depths do. Depth is 1/U: larger is nearer.
//
// Every value is defined: 0, less than 0 and no number are 0, as is all that lies below the format; above it
// is the largest word. Thread-safety: plain values.
#pragma once

#include <cstdint>

#include "librender/ars/words/ars_float.h"
#include "librender/ars/words/number_forms.h"

namespace deltaz::ars {

struct DepthFormat {
  int exponent_bits = 5, mantissa_bits = 19;  // at most 32 together
  LeadingOne leading_one = LeadingOne::kHidden;
  // The octave [1, 2) has this exponent. 31 puts a hither plane at one unit into the top octave.
  int exponent_bias = 31;

  bool operator==(const DepthFormat&) const = default;

  constexpr int bits() const { return exponent_bits + mantissa_bits; }
  constexpr int precision() const { return mantissa_bits + (leading_one == LeadingOne::kHidden ? 1 : 0); }
  constexpr std::uint32_t largestWord() const {
    return static_cast<std::uint32_t>((std::uint64_t{1} << bits()) - 1);
  }

  constexpr std::uint32_t encode(double depth, Rounding rounding) const {
    if (!(depth > 0)) return 0;
    const double rounded = roundToBits(depth, precision(), rounding, SignForm::kSignMagnitude);
    if (rounded >= powerOfTwo(largestExponent() + 1)) return largestWord();
    if (rounded < powerOfTwo(-exponent_bias)) return 0;
    const int exponent = leadingExponent(rounded);
    const auto significand = static_cast<std::uint32_t>(rounded * powerOfTwo(precision() - 1 - exponent));
    const std::uint32_t mantissa = significand & ((1u << mantissa_bits) - 1);
    return static_cast<std::uint32_t>(exponent + exponent_bias) << mantissa_bits | mantissa;
  }
  // The depth of a word. A written leading one that is 0 gives the value the bits have.
  constexpr double decode(std::uint32_t word) const {
    if (word == 0) return 0;
    std::uint32_t significand = word & ((1u << mantissa_bits) - 1);
    if (leading_one == LeadingOne::kHidden) significand |= 1u << mantissa_bits;
    const auto exponent = static_cast<int>(word >> mantissa_bits) - exponent_bias;
    return static_cast<double>(significand) * powerOfTwo(exponent - (precision() - 1));
  }

 private:
  constexpr int largestExponent() const { return (1 << exponent_bits) - 1 - exponent_bias; }
};

// The bias that puts depths up to 1 / hither into the top octave, with nothing to spare above.
constexpr int depthBiasForHither(double hither, int exponent_bits = 5) {
  const double nearest = 1 / hither;
  return (1 << exponent_bits) - 1 - leadingExponent(nearest);
}

}  // namespace deltaz::ars
