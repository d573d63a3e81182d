#include "librender/antialias/filter.h"

#include <cmath>
#include <gtest/gtest.h>

namespace deltaz {
namespace {

template <typename Check>
void forAllSamplings(Check&& check) {
  for (const int count : kSampleCounts) {
    for (const SamplePattern pattern : {SamplePattern::kOrdered, SamplePattern::kRotated}) {
      for (const FilterKind filter : kFilterKinds) {
        SCOPED_TRACE(std::to_string(count) + " " + std::string(samplePatternName(pattern)) + " " +
                     std::string(filterName(filter)));
        check(Sampling{count, pattern, filter});
      }
    }
  }
}

TEST(Filter, values_are_even_and_end_at_the_radius) {
  for (const FilterKind filter : kFilterKinds) {
    const double radius = filterRadius(filter);
    EXPECT_GT(filterValue(filter, 0), 0);
    for (double x = 0; x < 3; x += 0.01) EXPECT_EQ(filterValue(filter, x), filterValue(filter, -x));
    EXPECT_EQ(filterValue(filter, radius), 0);
    EXPECT_NE(filterValue(filter, radius - 0.01), 0);
    if (filter != FilterKind::kBox) {
      for (double x = 0; x < 3; x += 0.01)
        EXPECT_LT(std::abs(filterValue(filter, x + 0.01) - filterValue(filter, x)), 0.02);
    }
  }
}

TEST(Filter, mitchell_sums_to_one_over_all_pixels) {
  for (double x = -0.5; x < 0.5; x += 0.01) {
    double sum = 0;
    for (int k = -3; k <= 3; ++k) sum += filterValue(FilterKind::kMitchell, x + k);
    EXPECT_NEAR(sum, 1, 1e-12);
  }
}

// The report's 2 x 2 samples and kernel: [1 2 1] / 4 each way about a sample.
TEST(Filter, the_pyramid_falls_by_half_in_half_a_pixel) {
  EXPECT_EQ(filterValue(FilterKind::kPyramid, 0), 1);
  EXPECT_EQ(filterValue(FilterKind::kPyramid, 0.5), 0.5);
}

TEST(FilterKernel, a_box_weighs_the_pixels_own_samples_alike) {
  for (const int count : kSampleCounts) {
    const FilterKernel kernel({count, SamplePattern::kRotated, FilterKind::kBox});
    EXPECT_EQ(kernel.reach(), 0);
    for (int s = 0; s < count; ++s) EXPECT_EQ(kernel.weight(0, 0, s), 1);
    EXPECT_EQ(kernel.sum(0, 0, 1, 1), count);
  }
}

TEST(FilterKernel, reaches_every_sample_within_the_radius) {
  forAllSamplings([](const Sampling& sampling) {
    const FilterKernel kernel(sampling);
    const std::vector<SamplePlace> places = samplePlaces(sampling.count, sampling.pattern);
    double all = 0, reached = 0;
    for (int di = -4; di <= 4; ++di) {
      for (int dj = -4; dj <= 4; ++dj) {
        for (std::size_t s = 0; s < places.size(); ++s) {
          const double weight = filterValue(sampling.filter, dj + places[s].x / 256.0) *
                                filterValue(sampling.filter, di + places[s].y / 256.0);
          all += std::abs(weight);
          if (std::max(std::abs(dj), std::abs(di)) > kernel.reach()) continue;
          EXPECT_EQ(kernel.weight(dj, di, static_cast<int>(s)), weight);
          reached += std::abs(weight);
        }
      }
    }
    EXPECT_EQ(reached, all);
  });
}

// What an even grey would become without the division by it.
TEST(FilterKernel, sums_what_lies_within_the_picture) {
  forAllSamplings([](const Sampling& sampling) {
    const FilterKernel kernel(sampling);
    constexpr int kWidth = 5, kHeight = 3;
    for (int i = 0; i < kHeight; ++i) {
      for (int j = 0; j < kWidth; ++j) {
        double sum = 0;
        for (int ni = 0; ni < kHeight; ++ni) {
          for (int nj = 0; nj < kWidth; ++nj) {
            if (std::max(std::abs(ni - i), std::abs(nj - j)) > kernel.reach()) continue;
            for (int s = 0; s < sampling.count; ++s) sum += kernel.weight(nj - j, ni - i, s);
          }
        }
        EXPECT_NEAR(kernel.sum(j, i, kWidth, kHeight), sum, 1e-12);
        EXPECT_GT(sum, 0);
      }
    }
  });
}

}  // namespace
}  // namespace deltaz
