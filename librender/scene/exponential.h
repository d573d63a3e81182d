// exp(x) from multiplications and additions alone: the same bits on every machine, which the C library's
// function does not promise, and cheap enough for every pixel. Thread-safety: pure function.
#pragma once

#include <bit>
#include <cmath>
#include <cstdint>

namespace deltaz {

// Relative error below 1e-14. 0 below -700, exp(700) above 700.
inline double exponential(double x) {
  if (x < -700) return 0;
  if (x > 700) x = 700;
  // x = k ln 2 + r with |r| <= ln 2 / 2; ln 2 in two parts, so that k times the first is exact.
  const double k = static_cast<double>(std::lrint(x * 1.4426950408889634));
  const double r = (x - k * 0x1.62e42feep-1) - k * 0x1.a39ef35793c76p-33;
  constexpr double kCoefficients[] = {
      1.0 / 6227020800, 1.0 / 479001600, 1.0 / 39916800, 1.0 / 3628800, 1.0 / 362880, 1.0 / 40320, 1.0 / 5040,
      1.0 / 720,        1.0 / 120,       1.0 / 24,       1.0 / 6,       1.0 / 2,      1.0 / 1,     1.0 / 1};
  double sum = 0;
  for (const double coefficient : kCoefficients) sum = sum * r + coefficient;
  return sum * std::bit_cast<double>(static_cast<std::uint64_t>(1023 + static_cast<std::int64_t>(k)) << 52);
}

}  // namespace deltaz
