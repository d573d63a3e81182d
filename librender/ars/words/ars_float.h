// The machine's floating point (report Table 8): exponent sign, exponent, mantissa sign, mantissa, from the
// top bit down; 16 bits for colours, 32 for depth planes. Values are held as double, which has every number
// of these formats, and sums and products of two of them rounded in double and then to the format are what
// rounding once would give (precision <= 25, 2 x 25 + 2 <= 53).
//
// Every value is defined: too large saturates, too small is 0, no number is 0. Zero has its own word:
// mantissa 0 with the leading one written, the least exponent with it hidden. Thread-safety: plain values.
#pragma once

#include <bit>
#include <cstdint>

#include "librender/ars/words/number_forms.h"

namespace deltaz::ars {

inline constexpr int kLargestPrecision = 25, kLargestExponentBits = 8;

// 2^exponent, for exponents that double has as normal numbers.
constexpr double powerOfTwo(int exponent) {
  return std::bit_cast<double>(static_cast<std::uint64_t>(exponent + 1023) << 52);
}

// The exponent of the leading bit; x is finite, not 0 and no subnormal.
constexpr int leadingExponent(double x) {
  return static_cast<int>(std::bit_cast<std::uint64_t>(x) >> 52 & 0x7FF) - 1023;
}

// Rounds to so many significant bits (1..52), the exponent free. `remainder` has the sign of what the exact
// value exceeds x by, if x was rounded itself; it matters for truncation only. Subnormals are 0.
constexpr double roundToBits(double x, int precision, Rounding rounding, SignForm sign,
                             double remainder = 0) {
  constexpr std::uint64_t kSignBit = std::uint64_t{1} << 63, kInfinity = std::uint64_t{0x7FF} << 52;
  const auto bits = std::bit_cast<std::uint64_t>(x);
  std::uint64_t magnitude = bits & ~kSignBit;
  if (magnitude >= kInfinity) return magnitude == kInfinity ? x : 0.0;
  if (magnitude < std::uint64_t{1} << 52) return 0.0;
  const int dropped = 53 - precision;
  const std::uint64_t unit = std::uint64_t{1} << dropped, rest = magnitude & (unit - 1);
  if (rounding == Rounding::kNearest) {
    magnitude += (unit >> 1) - 1 + (magnitude >> dropped & 1);
    magnitude &= ~(unit - 1);
  } else {
    magnitude &= ~(unit - 1);
    const bool negative = (bits & kSignBit) != 0;
    if (negative && sign == SignForm::kTwosComplement) {
      if (rest != 0 || remainder < 0) magnitude += unit;
    } else if (rest == 0 && (negative ? remainder > 0 : remainder < 0)) {
      magnitude -= unit;  // also right across a power of two, where the last bit is worth half below
    }
  }
  return std::bit_cast<double>(magnitude | (bits & kSignBit));
}

struct FloatFormat {
  int exponent_bits = 0, mantissa_bits = 0;  // without signs
  LeadingOne leading_one = LeadingOne::kWritten;
  SignForm exponent_sign = SignForm::kSignMagnitude, mantissa_sign = SignForm::kSignMagnitude;

  bool operator==(const FloatFormat&) const = default;

  constexpr bool hidden() const { return leading_one == LeadingOne::kHidden; }
  constexpr int bits() const { return 2 + exponent_bits + mantissa_bits; }
  constexpr int precision() const { return mantissa_bits + (hidden() ? 1 : 0); }
  constexpr bool valid() const {
    return exponent_bits >= 1 && exponent_bits <= kLargestExponentBits && mantissa_bits >= 2 &&
           precision() <= kLargestPrecision && bits() <= 32;
  }
  // Exponents as written; of numbers, without the one that hidden leading ones need for zero.
  constexpr int largestExponent() const { return (1 << exponent_bits) - 1; }
  constexpr int leastExponent() const { return leastWritten() + (hidden() ? 1 : 0); }
  constexpr double largest() const {
    return (2.0 - powerOfTwo(1 - precision())) * powerOfTwo(largestExponent() - shift());
  }
  constexpr double least() const { return powerOfTwo(leastExponent() - shift()); }  // above 0

  // The number of this format for x.
  constexpr double round(double x, Rounding rounding, double remainder = 0) const {
    return inRange(roundToBits(x, precision(), rounding, mantissa_sign, remainder));
  }
  // The sum of two numbers of this format.
  constexpr double add(double a, double b, Rounding rounding) const {
    const double sum = a + b;
    if (rounding == Rounding::kNearest) return round(sum, rounding);
    const double b_part = sum - a, a_part = sum - b_part;  // what was lost, exactly (Knuth's two-sum)
    return round(sum, rounding, (a - a_part) + (b - b_part));
  }

  // The word that stands for a number of this format, and the number that any word stands for. Minus zero and
  // what is not normalised have theirs too; below the least normalised number it is 0.
  constexpr std::uint32_t encode(double number) const {
    if (number == 0) return hidden() ? exponentField(leastWritten()) << (mantissa_bits + 1) : 0;
    const bool negative = number < 0;
    int exponent = leadingExponent(number) + shift();
    const std::int64_t scale = std::int64_t{1} << (precision() - 1);
    auto significand =
        static_cast<std::int64_t>(number * powerOfTwo(shift() - exponent) * static_cast<double>(scale));
    if (negative && mantissa_sign == SignForm::kTwosComplement) {
      // -2^n is -1.0 x 2^n, not -0.1 x 2^(n + 1).
      if (significand == -scale) {
        significand *= 2;
        --exponent;
      }
    } else if (negative) {
      significand = -significand;
    }
    const std::uint32_t mantissa = static_cast<std::uint32_t>(significand) & ((1u << mantissa_bits) - 1);
    return exponentField(exponent) << (mantissa_bits + 1) |
           static_cast<std::uint32_t>(negative) << mantissa_bits | mantissa;
  }
  constexpr double decode(std::uint32_t word) const {
    const int exponent = exponentOf(word >> (mantissa_bits + 1) & ((2u << exponent_bits) - 1));
    const bool negative = (word >> mantissa_bits & 1) != 0;
    auto significand = static_cast<std::int64_t>(word & ((1u << mantissa_bits) - 1));
    if (hidden()) {
      if (exponent == leastWritten()) return 0;
      if (!negative || mantissa_sign == SignForm::kSignMagnitude)
        significand += std::int64_t{1} << mantissa_bits;
    }
    if (negative)
      significand = mantissa_sign == SignForm::kSignMagnitude
                        ? -significand
                        : significand - (std::int64_t{1} << precision());
    if (significand == 0) return 0;
    return inRange(static_cast<double>(significand) * powerOfTwo(exponent - shift() - (precision() - 1)));
  }

 private:
  // A fraction of one half and more has an exponent one above that of its leading bit.
  constexpr int shift() const { return hidden() ? 0 : 1; }
  constexpr int leastWritten() const {
    return exponent_sign == SignForm::kTwosComplement ? -largestExponent() - 1 : -largestExponent();
  }
  constexpr std::uint32_t exponentField(int exponent) const {
    const std::uint32_t sign_bit = 1u << exponent_bits;
    if (exponent >= 0) return static_cast<std::uint32_t>(exponent);
    return exponent_sign == SignForm::kTwosComplement
               ? static_cast<std::uint32_t>(exponent) & (2 * sign_bit - 1)
               : static_cast<std::uint32_t>(-exponent) | sign_bit;
  }
  constexpr int exponentOf(std::uint32_t field) const {
    const std::uint32_t sign_bit = 1u << exponent_bits;
    const auto low = static_cast<int>(field & (sign_bit - 1));
    if ((field & sign_bit) == 0) return low;
    return exponent_sign == SignForm::kTwosComplement ? low - static_cast<int>(sign_bit) : -low;
  }
  constexpr double inRange(double x) const {
    const bool downwards = mantissa_sign == SignForm::kTwosComplement;
    const double lowest = downwards ? -powerOfTwo(largestExponent() + 1 - shift()) : -largest();
    if (x > largest()) return largest();
    if (x < lowest) return lowest;
    if (x < 0 && downwards) return x < -least() ? x : 0.0;
    return x >= least() || x <= -least() ? x : 0.0;
  }
};

inline constexpr FloatFormat kColorFormat{.exponent_bits = 4,
                                          .mantissa_bits = 10};  // C0, DCDI, DCDJ, SCI, SCJ
inline constexpr FloatFormat kDepthPlaneFormat{.exponent_bits = 6,
                                               .mantissa_bits = 24};  // D0, DDDI, DDDJ, SDI, SDJ

}  // namespace deltaz::ars
