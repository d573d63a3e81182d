#include "tests/librender/antialias/analytic_coverage.h"

#include <cmath>
#include <gtest/gtest.h>
#include <random>

namespace deltaz {
namespace {

bool contains(const ConvexPolygon& polygon, double x, double y) {
  int left = 0;
  for (std::size_t k = 0; k < polygon.size(); ++k) {
    const ScreenPoint &a = polygon[k], &b = polygon[(k + 1) % polygon.size()];
    left += (b.x - a.x) * (y - a.y) - (b.y - a.y) * (x - a.x) > 0 ? 1 : -1;
  }
  return std::abs(left) == static_cast<int>(polygon.size());
}

// The slow way: a million places.
double denseCoverage(const ConvexPolygon& polygon, FilterKind filter, int j, int i) {
  constexpr int kSteps = 1000;
  const double radius = filterRadius(filter);
  double covered = 0, all = 0;
  for (int row = 0; row < kSteps; ++row) {
    const double y = ((row + 0.5) / kSteps * 2 - 1) * radius, of_row = filterValue(filter, y);
    for (int column = 0; column < kSteps; ++column) {
      const double x = ((column + 0.5) / kSteps * 2 - 1) * radius, weight = filterValue(filter, x) * of_row;
      all += weight;
      covered += contains(polygon, j + x, i + y) ? weight : 0;
    }
  }
  return covered / all;
}

TEST(AnalyticCoverage, is_what_a_million_places_say) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> unit(-1.5, 1.5);
  for (const FilterKind filter : kFilterKinds) {
    for (int n = 0; n < 5; ++n) {
      const ConvexPolygon triangle = {{5 + unit(random), 7 + unit(random)},
                                      {5 + unit(random), 7 + unit(random)},
                                      {5 + unit(random), 7 + unit(random)}};
      EXPECT_NEAR(analyticCoverage(triangle, filter, 5, 7), denseCoverage(triangle, filter, 5, 7), 1e-3)
          << filterName(filter);
    }
  }
}

TEST(AnalyticCoverage, of_parts_adds_up_to_all) {
  const ScreenPoint corners[] = {{-20, -30}, {40, -25}, {30, 50}, {-35, 28}};
  std::mt19937 random(5);
  std::uniform_real_distribution<double> unit(-1, 1);
  for (const FilterKind filter : kFilterKinds) {
    for (int n = 0; n < 20; ++n) {
      const ScreenPoint middle{unit(random), unit(random)};
      double sum = 0;
      for (std::size_t k = 0; k < 4; ++k)
        sum += analyticCoverage({middle, corners[k], corners[(k + 1) % 4]}, filter, 0, 0);
      EXPECT_NEAR(sum, 1, 1e-6) << filterName(filter);
    }
  }
}

}  // namespace
}  // namespace deltaz
