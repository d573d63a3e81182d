#include "librender/sweep/pareto_front.h"

#include <gtest/gtest.h>
#include <limits>
#include <random>

namespace deltaz {
namespace {

using Indices = std::vector<std::size_t>;

TEST(ParetoFront, keeps_what_nothing_else_beats) {
  const CostAndError points[] = {{3, 1}, {1, 4}, {2, 2}, {2.5, 3}, {4, 1}};
  EXPECT_EQ(paretoFront(points), (Indices{1, 2, 0}));
}

TEST(ParetoFront, takes_the_first_of_equals_and_nothing_infinite) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  const CostAndError points[] = {{kInfinity, 0}, {1, 1}, {1, 1}, {0, kInfinity}, {2, std::nan("")}};
  EXPECT_EQ(paretoFront(points), (Indices{1}));
  EXPECT_TRUE(paretoFront({}).empty());
}

// By the definition, on points among which ties are common.
TEST(ParetoFront, is_what_the_definition_says) {
  std::mt19937 random(9);
  for (int trial = 0; trial < 200; ++trial) {
    std::vector<CostAndError> points(1 + random() % 12);
    for (CostAndError& point : points)
      point = {static_cast<double>(random() % 5), static_cast<double>(random() % 5)};
    Indices expected;
    for (std::size_t k = 0; k < points.size(); ++k) {
      bool beaten = false;
      for (std::size_t other = 0; other < points.size(); ++other) {
        const bool no_worse = points[other].cost <= points[k].cost && points[other].error <= points[k].error;
        const bool equal = points[other].cost == points[k].cost && points[other].error == points[k].error;
        beaten = beaten || (other != k && no_worse && (!equal || other < k));
      }
      if (!beaten) expected.push_back(k);
    }
    Indices front = paretoFront(points);
    for (std::size_t k = 1; k < front.size(); ++k)
      EXPECT_LT(points[front[k - 1]].cost, points[front[k]].cost);
    std::sort(front.begin(), front.end());
    EXPECT_EQ(front, expected);
  }
}

}  // namespace
}  // namespace deltaz
