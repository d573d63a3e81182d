#include "libdb/source/simple_fraction.h"

#include <cmath>
#include <numeric>

namespace deltaz {

namespace {

constexpr std::int64_t kLargestPart = std::int64_t{1} << 53;
constexpr std::int64_t kLargestDenominator = 1000000;

// Parts of at most 2^53 each, so that a product of two always fits.
__extension__ using Wide = __int128;

std::optional<Rational> reduced(Wide numerator, Wide denominator) {
  Wide a = numerator < 0 ? -numerator : numerator, b = denominator;
  while (b != 0) {
    const Wide rest = a % b;
    a = b;
    b = rest;
  }
  numerator /= a;
  denominator /= a;
  if (numerator > kLargestPart || numerator < -kLargestPart || denominator > kLargestPart)
    return std::nullopt;
  return Rational{static_cast<std::int64_t>(numerator), static_cast<std::int64_t>(denominator)};
}

}  // namespace

std::optional<Rational> simplestFraction(double value, double tolerance, std::int64_t largest_denominator) {
  if (!(value < static_cast<double>(kLargestPart))) return std::nullopt;
  std::int64_t previous_numerator = 1, numerator = static_cast<std::int64_t>(std::floor(value));
  std::int64_t previous_denominator = 0, denominator = 1;
  double rest = value - std::floor(value);
  while (std::abs(value - static_cast<double>(numerator) / static_cast<double>(denominator)) > tolerance ||
         numerator == 0) {
    if (rest < 1e-12) return std::nullopt;
    const double inverse = 1.0 / rest;
    const double whole = std::floor(inverse);
    if (whole > static_cast<double>(largest_denominator)) return std::nullopt;
    const auto term = static_cast<std::int64_t>(whole);
    rest = inverse - whole;
    const std::int64_t next_denominator = term * denominator + previous_denominator;
    if (next_denominator > largest_denominator) return std::nullopt;
    const Wide next_numerator = Wide{term} * numerator + previous_numerator;
    if (next_numerator > kLargestPart) return std::nullopt;
    previous_numerator = numerator;
    previous_denominator = denominator;
    numerator = static_cast<std::int64_t>(next_numerator);
    denominator = next_denominator;
  }
  return Rational{numerator, denominator};
}

std::optional<Rational> fractionOf(double value) {
  if (value == 0) return Rational{0, 1};
  const double magnitude = std::abs(value);
  // Half a unit in the last place of a double, then of a float.
  for (const double relative : {1.2e-16, 6e-8}) {
    std::optional<Rational> found = simplestFraction(magnitude, magnitude * relative, kLargestDenominator);
    if (!found) continue;
    const bool exact = found->value() == magnitude;
    const bool as_float = static_cast<double>(static_cast<float>(magnitude)) == magnitude &&
                          static_cast<float>(found->value()) == static_cast<float>(magnitude);
    if (!exact && !as_float) continue;
    if (value < 0) found->numerator = -found->numerator;
    return found;
  }
  return std::nullopt;
}

std::optional<Rational> product(const Rational& a, const Rational& b) {
  return reduced(Wide{a.numerator} * b.numerator, Wide{a.denominator} * b.denominator);
}

std::optional<Rational> quotient(const Rational& a, const Rational& b) {
  const std::int64_t sign = b.numerator < 0 ? -1 : 1;
  return product(a, {sign * b.denominator, sign * b.numerator});
}

std::optional<Rational> commonMeasure(const Rational& a, const Rational& b) {
  // gcd(p/q, r/s) = gcd(p s, r q) / (q s)
  Wide x = Wide{a.numerator} * b.denominator, y = Wide{b.numerator} * a.denominator;
  if (x < 0) x = -x;
  if (y < 0) y = -y;
  while (y != 0) {
    const Wide rest = x % y;
    x = y;
    y = rest;
  }
  return reduced(x, Wide{a.denominator} * b.denominator);
}

}  // namespace deltaz
