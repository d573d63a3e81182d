#include "librender/ars/words/ars_float.h"

#include <cmath>
#include <gtest/gtest.h>
#include <limits>
#include <map>
#include <random>
#include <string>
#include <vector>

namespace deltaz::ars {
namespace {

constexpr LeadingOne kLeadingOnes[] = {LeadingOne::kWritten, LeadingOne::kHidden};
constexpr SignForm kSignForms[] = {SignForm::kSignMagnitude, SignForm::kTwosComplement};
constexpr Rounding kRoundings[] = {Rounding::kNearest, Rounding::kTruncate};

std::vector<FloatFormat> allForms(FloatFormat format) {
  std::vector<FloatFormat> forms;
  for (const LeadingOne leading : kLeadingOnes) {
    for (const SignForm exponent : kSignForms) {
      for (const SignForm mantissa : kSignForms) {
        format.leading_one = leading;
        format.exponent_sign = exponent;
        format.mantissa_sign = mantissa;
        forms.push_back(format);
      }
    }
  }
  return forms;
}

std::string named(const FloatFormat& format) {
  return std::string(format.hidden() ? "hidden" : "written") +
         (format.exponent_sign == SignForm::kTwosComplement ? ", exponent two's" : ", exponent sign") +
         (format.mantissa_sign == SignForm::kTwosComplement ? ", mantissa two's" : ", mantissa sign");
}

// Digest section 15: colour <= 32,736; section 6.3: 2^+-63, relative last bit 2^-24.
TEST(ArsFloat, has_the_ranges_of_table_8) {
  static_assert(kColorFormat.bits() == 16 && kDepthPlaneFormat.bits() == 32);
  EXPECT_EQ(kColorFormat.largest(), 32736);
  EXPECT_EQ(kColorFormat.decode(0x7BFF), 32736);
  EXPECT_EQ(kDepthPlaneFormat.largest(), std::ldexp(1 - std::ldexp(1.0, -24), 63));
  EXPECT_EQ(kDepthPlaneFormat.least(), std::ldexp(1.0, -64));
}

TEST(ArsFloat, places_sign_exponent_sign_mantissa_from_the_top) {
  EXPECT_EQ(kColorFormat.encode(0.5), 0x0200u);             // 0.1 x 2^0
  EXPECT_EQ(kColorFormat.encode(-1), 1u << 11 | 0x0600u);   // -0.1 x 2^1
  EXPECT_EQ(kColorFormat.encode(0.125), 0x9000u | 0x200u);  // 0.1 x 2^-2
  EXPECT_EQ(kDepthPlaneFormat.encode(1), 1u << 25 | 1u << 23);
  EXPECT_EQ(kDepthPlaneFormat.encode(-0.25), 1u << 31 | 1u << 25 | 1u << 24 | 1u << 23);
}

TEST(ArsFloat, words_of_sixteen_bits_have_values_that_come_back) {
  for (const FloatFormat& format : allForms(kColorFormat)) {
    int normalised = 0;
    std::map<double, std::uint32_t> words;  // of each value, the canonical one
    for (std::uint32_t word = 0; word < 0x10000; ++word) {
      const double value = format.decode(word);
      ASSERT_TRUE(std::isfinite(value));
      for (const Rounding rounding : kRoundings) {
        ASSERT_EQ(format.round(value, rounding), value) << named(format) << " word " << word;
      }
      const double number = format.round(value, Rounding::kNearest);
      const std::uint32_t canonical = format.encode(number);
      ASSERT_LT(canonical, 0x10000u);
      ASSERT_EQ(format.decode(canonical), number) << named(format) << " word " << word;
      normalised += canonical == word && number == value ? 1 : 0;
      words[number] = canonical;
    }
    // As many canonical words as values: half of all fractions are normalised; all words but those of a few
    // exponents hide the one.
    EXPECT_EQ(normalised, static_cast<int>(words.size())) << named(format);
    EXPECT_GT(normalised, format.hidden() ? 60000 : 31000) << named(format);
  }
}

TEST(ArsFloat, rounds_to_one_of_the_two_neighbours) {
  for (const FloatFormat& format : allForms(kColorFormat)) {
    std::map<double, bool> values;
    for (std::uint32_t word = 0; word < 0x10000; ++word)
      values[format.round(format.decode(word), Rounding::kNearest)];
    auto low = values.begin();
    for (auto high = std::next(low); high != values.end(); low = high++) {
      const double a = low->first, b = high->first;
      for (const double part : {0.0, 0.25, 0.499999, 0.500001, 0.75, 1.0}) {
        const double x = a + part * (b - a);
        // Whatever lies below the least number is 0.
        const bool near_zero = a == 0 || b == 0;
        const double nearest = format.round(x, Rounding::kNearest),
                     truncated = format.round(x, Rounding::kTruncate);
        if (near_zero) {
          ASSERT_TRUE(nearest == a || nearest == b);
          ASSERT_TRUE(truncated == a || truncated == b);
          continue;
        }
        ASSERT_EQ(nearest, part < 0.5 ? a : b) << named(format) << " " << x;
        const bool downwards = x > 0 || format.mantissa_sign == SignForm::kTwosComplement;
        const double dropped = x == a || x == b ? x : (downwards ? a : b);
        ASSERT_EQ(truncated, dropped) << named(format) << " " << x;
      }
      if (a != 0 && b != 0) {
        const double tie = format.round(a + 0.5 * (b - a), Rounding::kNearest);
        ASSERT_TRUE(tie == a || tie == b);
      }
    }
  }
}

TEST(ArsFloat, is_exact_at_every_exponent_boundary) {
  for (const FloatFormat& format : allForms(kDepthPlaneFormat)) {
    if (!format.valid()) continue;
    for (int exponent = -70; exponent <= 70; ++exponent) {
      for (const double sign : {1.0, -1.0}) {
        const double power = sign * powerOfTwo(exponent), ulp = std::ldexp(power, 1 - format.precision());
        for (const double x : {power, power + ulp, power - ulp / 2}) {
          const double number = format.round(x, Rounding::kNearest);
          ASSERT_EQ(format.decode(format.encode(number)), number) << named(format) << " " << x;
          if (exponent > -61 && exponent < 61) {
            ASSERT_EQ(number, x);
          }
        }
      }
    }
  }
}

TEST(ArsFloat, every_value_is_defined) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  for (const FloatFormat& format : allForms(kColorFormat)) {
    for (const Rounding rounding : kRoundings) {
      EXPECT_EQ(format.round(1e300, rounding), format.largest());
      EXPECT_EQ(format.round(kInfinity, rounding), format.largest());
      EXPECT_LE(format.round(-kInfinity, rounding), -format.largest());
      EXPECT_EQ(format.round(-kInfinity, rounding), format.round(-1e300, rounding));
      EXPECT_EQ(format.round(std::numeric_limits<double>::quiet_NaN(), rounding), 0);
      EXPECT_EQ(format.round(1e-300, rounding), 0);
      EXPECT_EQ(format.round(std::numeric_limits<double>::denorm_min(), rounding), 0);
    }
    EXPECT_EQ(format.decode(format.encode(0.0)), 0);
    EXPECT_EQ(format.decode(format.encode(-0.0)), 0);
  }
}

TEST(ArsFloat, rounding_is_monotonic) {
  std::mt19937_64 random(1);
  for (const FloatFormat& format : allForms(kColorFormat)) {
    for (const Rounding rounding : kRoundings) {
      std::vector<double> values;
      for (int i = 0; i < 20000; ++i)
        values.push_back(
            std::ldexp(static_cast<double>(random() % 4000) - 2000, static_cast<int>(random() % 40) - 30));
      std::sort(values.begin(), values.end());
      for (std::size_t i = 1; i < values.size(); ++i)
        ASSERT_LE(format.round(values[i - 1], rounding), format.round(values[i], rounding));
    }
  }
}

// long double holds sums of numbers whose exponents differ by less than 40 exactly.
TEST(ArsFloat, sums_are_exact_sums_rounded_once) {
  std::mt19937_64 random(2);
  for (const FloatFormat& format : allForms(kDepthPlaneFormat)) {
    if (!format.valid()) continue;
    for (int i = 0; i < 20000; ++i) {
      const auto draw = [&] {
        const double x = std::ldexp(static_cast<double>(random() % (1u << 25)) - (1 << 24),
                                    static_cast<int>(random() % 38) - 40);
        return format.round(x, Rounding::kNearest);
      };
      const double a = draw(), b = draw();
      const long double exact = static_cast<long double>(a) + b;
      for (const Rounding rounding : kRoundings) {
        const double sum = format.add(a, b, rounding);
        ASSERT_EQ(format.round(sum, Rounding::kNearest), sum);
        if (exact == 0) {
          ASSERT_EQ(sum, 0);
          continue;
        }
        const long double ulp = std::ldexp(1.0L, std::ilogb(exact) + 1 - format.precision());
        const long double error = static_cast<long double>(sum) - exact;
        if (rounding == Rounding::kNearest) {
          ASSERT_LE(std::abs(error), ulp / 2) << a << " + " << b;
        } else if (exact < 0 && format.mantissa_sign == SignForm::kSignMagnitude) {
          ASSERT_TRUE(error >= 0 && error < ulp) << a << " + " << b;
        } else {
          ASSERT_TRUE(error <= 0 && error > -ulp) << a << " + " << b;
        }
      }
    }
  }
}

// A truncated sum of numbers far apart steps to the neighbour, also below a power of two.
TEST(ArsFloat, truncated_sums_see_what_double_cannot_hold) {
  const double tiny = powerOfTwo(-62);
  EXPECT_EQ(kDepthPlaneFormat.add(1, -tiny, Rounding::kTruncate), 1 - powerOfTwo(-24));
  EXPECT_EQ(kDepthPlaneFormat.add(1, tiny, Rounding::kTruncate), 1);
  EXPECT_EQ(kDepthPlaneFormat.add(-1, tiny, Rounding::kTruncate), -1 + powerOfTwo(-24));
  FloatFormat twos = kDepthPlaneFormat;
  twos.mantissa_sign = SignForm::kTwosComplement;
  EXPECT_EQ(twos.add(-1, -tiny, Rounding::kTruncate), -1 - powerOfTwo(-23));
  EXPECT_EQ(twos.add(-1, tiny, Rounding::kTruncate), -1);
}

}  // namespace
}  // namespace deltaz::ars
