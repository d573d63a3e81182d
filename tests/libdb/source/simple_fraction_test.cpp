#include "libdb/source/simple_fraction.h"

#include <gtest/gtest.h>
#include <numeric>
#include <rapidcheck/gtest.h>

namespace deltaz {
namespace {

TEST(SimpleFraction, decimals_are_the_fractions_they_were_written_as) {
  EXPECT_EQ(fractionOf(0.1), (Rational{1, 10}));
  EXPECT_EQ(fractionOf(0.25), (Rational{1, 4}));
  EXPECT_EQ(fractionOf(-12.5), (Rational{-25, 2}));
  EXPECT_EQ(fractionOf(0), (Rational{0, 1}));
  EXPECT_EQ(fractionOf(0.3048), (Rational{381, 1250}));
  EXPECT_EQ(fractionOf(static_cast<double>(0.1f)), (Rational{1, 10})) << "a float's decimal too";
  EXPECT_EQ(fractionOf(3.141592653589793), std::nullopt);
}

RC_GTEST_PROP(SimpleFraction, every_decimal_of_six_places_is_found, ()) {
  const auto numerator = *rc::gen::inRange<std::int64_t>(-2000000000, 2000000000);
  const std::int64_t denominator = *rc::gen::element<std::int64_t>(1, 2, 3, 10, 100, 1000, 1000000);
  const double value = static_cast<double>(numerator) / static_cast<double>(denominator);
  const std::optional<Rational> found = fractionOf(value);
  RC_ASSERT(found.has_value());
  RC_ASSERT(found->value() == value);
}

RC_GTEST_PROP(SimpleFraction, the_common_measure_divides_both_and_nothing_larger_does, ()) {
  const auto part = rc::gen::inRange<std::int64_t>(1, 5000);
  const Rational a{*part, *part}, b{*part, *part};
  const std::optional<Rational> common = commonMeasure(a, b);
  RC_ASSERT(common.has_value());
  const std::optional<Rational> times_a = quotient(a, *common), times_b = quotient(b, *common);
  RC_ASSERT(times_a->denominator == 1 && times_b->denominator == 1);
  RC_ASSERT(std::gcd(times_a->numerator, times_b->numerator) == 1);
}

TEST(SimpleFraction, what_does_not_fit_is_nothing) {
  const Rational tiny{1, (std::int64_t{1} << 53) - 1}, other{1, (std::int64_t{1} << 53) - 111};
  EXPECT_EQ(product(tiny, other), std::nullopt);
  EXPECT_EQ(commonMeasure(tiny, other), std::nullopt);
}

}  // namespace
}  // namespace deltaz
