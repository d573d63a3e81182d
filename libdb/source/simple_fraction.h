// Exact fractions behind numbers that were written as decimals. Pure functions.
#pragma once

#include <cstdint>
#include <optional>

#include "formats/area.h"

namespace deltaz {

// The simplest fraction within `tolerance` of `value` > 0 (continued fraction); nothing if its denominator
// would be above `largest_denominator`.
std::optional<Rational> simplestFraction(double value, double tolerance, std::int64_t largest_denominator);

// The fraction a number stands for: one with a denominator of at most 10^6 that rounds to exactly this
// double, or (numbers kept as float in between) to exactly this float. Zero and negative values too.
std::optional<Rational> fractionOf(double value);

// Lowest terms; nothing if a part would exceed 2^53, which is what the format holds. Denominators stay > 0.
std::optional<Rational> product(const Rational& a, const Rational& b);
std::optional<Rational> quotient(const Rational& a, const Rational& b);  // b != 0
// The largest fraction that both are whole multiples of; the other one's magnitude if one is zero.
std::optional<Rational> commonMeasure(const Rational& a, const Rational& b);

}  // namespace deltaz
