// exp(x) from multiplications and additions alone: the same bits on every machine, which the C library's
// function does not promise, and cheap enough for every pixel. Thread-safety: pure function.
#pragma once

#include <bit>
#include <cmath>
#include <cstdint>

namespace deltaz {

// ln 2 in two parts, so that small whole multiples of the first are exact; the series from its end.
inline constexpr double kLog2OfE = 1.4426950408889634;
inline constexpr double kLn2High = 0x1.62e42feep-1, kLn2Low = 0x1.a39ef35793c76p-33;
inline constexpr double kExponentialCoefficients[] = {
    1.0 / 6227020800, 1.0 / 479001600, 1.0 / 39916800, 1.0 / 3628800, 1.0 / 362880, 1.0 / 40320, 1.0 / 5040,
    1.0 / 720,        1.0 / 120,       1.0 / 24,       1.0 / 6,       1.0 / 2,      1.0 / 1,     1.0 / 1};
inline constexpr double kLeastExponent = -700, kGreatestExponent = 700;

// Relative error below 1e-14. 0 below -700, exp(700) above 700.
inline double exponential(double x) {
  if (x < kLeastExponent) return 0;
  if (x > kGreatestExponent) x = kGreatestExponent;
  // x = k ln 2 + r with |r| <= ln 2 / 2.
  const double k = static_cast<double>(std::lrint(x * kLog2OfE));
  const double r = (x - k * kLn2High) - k * kLn2Low;
  double sum = 0;
  for (const double coefficient : kExponentialCoefficients) sum = sum * r + coefficient;
  return sum * std::bit_cast<double>(static_cast<std::uint64_t>(1023 + static_cast<std::int64_t>(k)) << 52);
}

}  // namespace deltaz
