// Binary fixed point (report Table 8): sign, integer bits, fraction bits. Numbers are held as integers in
// units of the last bit.
//
// Every value is defined: what is too large saturates, what is no number is 0. Thread-safety: plain values.
#pragma once

#include <algorithm>
#include <cstdint>

#include "librender/ars/words/number_forms.h"

namespace deltaz::ars {

struct FixedPointFormat {
  int integer_bits = 0, fraction_bits = 0;  // at most 52 together
  SignForm sign = SignForm::kTwosComplement;

  bool operator==(const FixedPointFormat&) const = default;

  constexpr int bits() const { return 1 + integer_bits + fraction_bits; }
  constexpr std::int64_t one() const { return std::int64_t{1} << fraction_bits; }
  constexpr std::int64_t largest() const { return (std::int64_t{1} << (integer_bits + fraction_bits)) - 1; }
  constexpr std::int64_t least() const {
    return sign == SignForm::kTwosComplement ? -largest() - 1 : -largest();
  }

  constexpr double value(std::int64_t raw) const {
    return static_cast<double>(raw) / static_cast<double>(one());
  }
  constexpr std::int64_t saturated(std::int64_t raw) const { return std::clamp(raw, least(), largest()); }

  // The nearest number, of two the greater.
  constexpr std::int64_t nearest(double x) const {
    const double scaled = x * static_cast<double>(one());
    if (!(scaled == scaled)) return 0;
    if (scaled >= static_cast<double>(largest())) return largest();
    if (scaled <= static_cast<double>(least())) return least();
    auto whole = static_cast<std::int64_t>(scaled);
    if (static_cast<double>(whole) > scaled) --whole;
    return whole + (scaled - static_cast<double>(whole) >= 0.5 ? 1 : 0);
  }

  // The word of bits() bits that stands for a number of this format, and back. Minus zero reads as zero.
  constexpr std::uint64_t encode(std::int64_t raw) const {
    const std::uint64_t mask = (std::uint64_t{1} << bits()) - 1;
    if (sign == SignForm::kTwosComplement) return static_cast<std::uint64_t>(raw) & mask;
    return raw < 0 ? static_cast<std::uint64_t>(-raw) | std::uint64_t{1} << (bits() - 1)
                   : static_cast<std::uint64_t>(raw);
  }
  constexpr std::int64_t decode(std::uint64_t word) const {
    const std::uint64_t sign_bit = std::uint64_t{1} << (bits() - 1);
    const auto low = static_cast<std::int64_t>(word & (sign_bit - 1));
    if ((word & sign_bit) == 0) return low;
    return sign == SignForm::kTwosComplement ? low - static_cast<std::int64_t>(sign_bit) : -low;
  }
};

inline constexpr FixedPointFormat kVertexFormat{.integer_bits = 9, .fraction_bits = 6};  // RI, RJ, NI, NJ
inline constexpr FixedPointFormat kDotProductFormat{.integer_bits = 19, .fraction_bits = 8};  // P

// A coordinate in units of 2^-fraction_bits, to the nearest pixel, of two the greater: ISTART, JSTART, ISTOP,
// JSTOP.
constexpr int nearestPixel(std::int64_t raw, int fraction_bits) {
  return fraction_bits == 0
             ? static_cast<int>(raw)
             : static_cast<int>((raw + (std::int64_t{1} << (fraction_bits - 1))) >> fraction_bits);
}

}  // namespace deltaz::ars
