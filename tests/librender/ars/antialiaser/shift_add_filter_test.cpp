#include "librender/ars/antialiaser/shift_add_filter.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <gtest/gtest.h>
#include <numeric>
#include <random>
#include <set>

namespace deltaz::ars {
namespace {

constexpr int kSide = 512;

ShiftAddKernel reportKernel() {
  return shiftAddKernelNamed("report").value();
}

std::vector<std::uint8_t> noise() {
  std::mt19937 random(44);
  std::vector<std::uint8_t> samples(std::size_t{kSide} * kSide);
  for (std::uint8_t& sample : samples) sample = static_cast<std::uint8_t>(random());
  return samples;
}

// What each sample along an axis weighs in all pixels together.
std::vector<double> axisWeights(const ShiftAddKernel& kernel, int size) {
  std::vector<double> weights(static_cast<std::size_t>(size));
  for (int pixel = 0; pixel < size / kernel.ratio; ++pixel)
    for (int tap = 0; tap < kernel.taps(); ++tap)
      weights[static_cast<std::size_t>(std::clamp(kernel.firstSample(pixel) + tap, 0, size - 1))] +=
          std::ldexp(kernel.weights[static_cast<std::size_t>(tap)], -kernel.shift);
  return weights;
}

// The same filter without rounding.
std::vector<double> exact(const ShiftAddKernel& kernel, const std::vector<std::uint8_t>& samples, int size) {
  const int pixels = size / kernel.ratio;
  std::vector<double> result;
  for (int i = 0; i < pixels; ++i) {
    for (int j = 0; j < pixels; ++j) {
      double sum = 0;
      for (int di = 0; di < kernel.taps(); ++di) {
        for (int dj = 0; dj < kernel.taps(); ++dj) {
          const int line = std::clamp(kernel.firstSample(i) + di, 0, size - 1);
          const int column = std::clamp(kernel.firstSample(j) + dj, 0, size - 1);
          sum += kernel.weights[static_cast<std::size_t>(di)] * kernel.weights[static_cast<std::size_t>(dj)] *
                 static_cast<double>(samples[static_cast<std::size_t>(line * size + column)]);
        }
      }
      result.push_back(std::ldexp(sum, -2 * kernel.shift));
    }
  }
  return result;
}

struct Bias {
  double mean = 0, least = 0, most = 0;
};

Bias bias(const ShiftAddKernel& kernel, const FilterArithmetic& arithmetic) {
  const std::vector<std::uint8_t> samples = noise();
  const std::vector<std::uint8_t> picture = filtered(kernel, samples, kSide, kSide, arithmetic);
  const std::vector<double> truth = exact(kernel, samples, kSide);
  Bias result{.least = 1e9, .most = -1e9};
  for (std::size_t k = 0; k < truth.size(); ++k) {
    const double error = picture[k] - truth[k];
    result.mean += error / static_cast<double>(truth.size());
    result.least = std::min(result.least, error);
    result.most = std::max(result.most, error);
  }
  return result;
}

TEST(ShiftAddFilter, report_kernel_is_1_2_1_twice) {
  const ShiftAddKernel kernel = reportKernel();
  EXPECT_EQ(std::vector<int>(kernel.weights.begin(), kernel.weights.end()), (std::vector{1, 2, 1}));
  // ((a + c) >> 1 + b) >> 1, as the report builds it, is the sum shifted once.
  for (int a = 0; a < 256; a += 3)
    for (int b = 0; b < 256; ++b)
      for (int c = 0; c < 256; c += 5) ASSERT_EQ((((a + c) >> 1) + b) >> 1, (a + 2 * b + c) >> 2);
}

TEST(ShiftAddFilter, kernels_sum_to_a_power_of_two_and_are_even) {
  std::set<std::string_view> names;
  for (const ShiftAddKernel& kernel : shiftAddKernels()) {
    EXPECT_TRUE(names.insert(kernel.name).second);
    EXPECT_EQ(std::accumulate(kernel.weights.begin(), kernel.weights.end(), 0), 1 << kernel.shift)
        << kernel.name;
    EXPECT_TRUE(std::equal(kernel.weights.begin(), kernel.weights.end(), kernel.weights.rbegin()))
        << kernel.name;
    EXPECT_EQ(shiftAddKernelNamed(kernel.name)->ratio, kernel.ratio);
  }
  EXPECT_EQ(shiftAddKernelNamed("none"), std::nullopt);
  EXPECT_EQ(reportKernel().adders(), 2);
}

// Digest 9 and 15.
TEST(ShiftAddFilter, flat_fields_stay_exact) {
  for (const ShiftAddKernel& kernel : shiftAddKernels()) {
    for (const int color : {0, 1, 127, 254, 255}) {
      const std::vector<std::uint8_t> flat(64 * 64, static_cast<std::uint8_t>(color));
      for (const bool rounding : {false, true}) {
        const auto picture = filtered(kernel, flat, 64, 64, {.guard_bits = 3, .rounding = rounding});
        EXPECT_EQ(picture.size(), 64U * 64U / static_cast<unsigned>(kernel.ratio * kernel.ratio));
        EXPECT_EQ(std::count(picture.begin(), picture.end(), color), std::ptrdiff_t(picture.size()))
            << kernel.name;
      }
    }
  }
}

// Digest 9: 127 inside, 95 or 127 on the first row and column.
TEST(ShiftAddFilter, checkerboard_becomes_127) {
  std::vector<std::uint8_t> board(std::size_t{kSide} * kSide);
  for (std::size_t i = 0; i < kSide; ++i)
    for (std::size_t j = 0; j < kSide; ++j) board[i * kSide + j] = (i + j) % 2 == 1 ? 255 : 0;
  const std::vector<std::uint8_t> picture = filtered(reportKernel(), board, kSide, kSide);
  for (std::size_t i = 0; i < 256; ++i) {
    for (std::size_t j = 0; j < 256; ++j) {
      const int expected = i == 0 && j == 0 ? 95 : 127;
      ASSERT_EQ(picture[i * 256 + j], expected) << i << ", " << j;
    }
  }
}

// Digest 9: -.75 on the average, -1.5 at worst, never positive.
TEST(ShiftAddFilter, truncation_darkens_by_three_quarters_of_a_grey_level) {
  const Bias report = bias(reportKernel(), {});
  EXPECT_NEAR(report.mean, -0.75, 0.01);
  EXPECT_EQ(report.least, -1.5);
  EXPECT_EQ(report.most, 0);
}

TEST(ShiftAddFilter, guard_bits_and_rounding_take_the_bias_away) {
  for (const ShiftAddKernel& kernel : shiftAddKernels()) {
    const double plain = bias(kernel, {}).mean, guarded = bias(kernel, {.guard_bits = 8}).mean;
    EXPECT_LT(plain, guarded) << kernel.name;
    const Bias rounded = bias(kernel, {.guard_bits = 8, .rounding = true});
    // Halves go up; with few fractional bits they are frequent.
    EXPECT_LT(std::abs(rounded.mean), 0.13) << kernel.name;
    EXPECT_LE(rounded.most, 0.76) << kernel.name;
    EXPECT_GE(rounded.least, -0.76) << kernel.name;
  }
}

// Digest 9: 18 % of the outputs.
TEST(ShiftAddFilter, order_of_the_levels_shows_in_18_percent_of_pixels) {
  const std::vector<std::uint8_t> samples = noise();
  const auto across = filtered(reportKernel(), samples, kSide, kSide);
  const auto down = filtered(reportKernel(), samples, kSide, kSide, {.down_first = true});
  int different = 0;
  for (std::size_t k = 0; k < across.size(); ++k) different += across[k] != down[k] ? 1 : 0;
  EXPECT_NEAR(100.0 * different / static_cast<double>(across.size()), 18, 1);
}

// Digest 9: .25 inside, .5625 in the first corner, .125 along the last row and column, .0625 in that corner.
TEST(ShiftAddFilter, samples_weigh_as_the_duplicated_row_and_column_make_them) {
  const std::vector<double> axis = axisWeights(reportKernel(), kSide);
  const double inside = axis[100], first = axis.front(), last = axis.back();
  EXPECT_EQ(inside * axis[101], 0.25);
  EXPECT_EQ(first * first, 0.5625);
  EXPECT_EQ(last * inside, 0.125);
  EXPECT_EQ(last * last, 0.0625);
}

TEST(ShiftAddFilter, even_kernels_lie_in_the_middle_of_their_pixel) {
  for (const ShiftAddKernel& kernel : shiftAddKernels()) {
    if (kernel.taps() % 2 != kernel.ratio % 2) continue;
    const double middle = kernel.firstSample(3) + (kernel.taps() - 1) / 2.0;
    EXPECT_EQ(middle, 3 * kernel.ratio + (kernel.ratio - 1) / 2.0) << kernel.name;
  }
}

// Report 4.4.4: 514; 4.4.5: larger filters wait for more lines.
TEST(ShiftAddFilter, waits_for_514_samples_and_for_more_with_larger_kernels) {
  EXPECT_EQ(latency(reportKernel(), kSide), 514);
  EXPECT_EQ(latency(shiftAddKernelNamed("box-2").value(), kSide), 514);
  EXPECT_EQ(latency(shiftAddKernelNamed("pyramid-4").value(), kSide), 5 * 512 + 6);
}

}  // namespace
}  // namespace deltaz::ars
