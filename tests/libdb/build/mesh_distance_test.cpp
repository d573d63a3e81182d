#include "libdb/build/mesh_distance.h"

#include <algorithm>
#include <gtest/gtest.h>
#include <random>

#include "tests/support/sampled_distance.h"

namespace deltaz {
namespace {

struct Soup {
  std::vector<Vector3> positions;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  TriangleView view() const { return {positions, triangles}; }
};

// A sheet over the unit square, `steps` cells a side, whose height is a function of place.
template <typename Height>
Soup sheet(std::uint32_t steps, const Height& height) {
  Soup soup;
  for (std::uint32_t j = 0; j <= steps; ++j) {
    for (std::uint32_t i = 0; i <= steps; ++i) {
      const double x = static_cast<double>(i) / steps, y = static_cast<double>(j) / steps;
      soup.positions.push_back({x, y, height(x, y)});
    }
  }
  for (std::uint32_t j = 0; j < steps; ++j) {
    for (std::uint32_t i = 0; i < steps; ++i) {
      const std::uint32_t a = j * (steps + 1) + i, c = a + steps + 1;
      soup.triangles.push_back({a, a + 1, c + 1});
      soup.triangles.push_back({a, c + 1, c});
    }
  }
  return soup;
}

double bound(const Soup& a, const Soup& b) {
  const NearestTriangle of_a(a.view()), of_b(b.view());
  return meshDistanceBound(of_a, of_b, 1e-9);
}

TEST(MeshDistance, is_nothing_between_a_sheet_and_the_same_sheet_cut_otherwise) {
  const auto flat = [](double, double) { return 0.0; };
  const double found = bound(sheet(1, flat), sheet(17, flat));
  EXPECT_GE(found, 0);
  EXPECT_LE(found, 1e-9);
}

TEST(MeshDistance, is_that_of_parallel_sheets) {
  const double found =
      bound(sheet(3, [](double, double) { return 0.0; }), sheet(7, [](double, double) { return 0.125; }));
  EXPECT_GE(found, 0.125);
  EXPECT_LE(found, 0.125 * (1 + kDistanceTightness));
}

TEST(MeshDistance, counts_what_only_one_mesh_has) {
  const auto flat = [](double, double) { return 0.0; };
  Soup more = sheet(1, flat);
  // A flag far from the sheet, seen from one side only.
  const auto first = static_cast<std::uint32_t>(more.positions.size());
  for (const Vector3& p : {Vector3{0, 0, 5}, Vector3{1, 0, 5}, Vector3{0, 1, 5}}) more.positions.push_back(p);
  more.triangles.push_back({first, first + 1, first + 2});
  for (const double found : {bound(more, sheet(1, flat)), bound(sheet(1, flat), more)}) {
    EXPECT_GE(found, 5);
    EXPECT_LE(found, 5 * (1 + kDistanceTightness));
  }
}

TEST(MeshDistance, finds_a_peak_between_the_corners_of_the_other_mesh) {
  // The farthest point of the flat sheet from the tent lies where no mesh has a corner.
  const auto tent = [](double x, double) { return x < 0.5 ? x : 1 - x; };
  const double found = bound(sheet(2, tent), sheet(1, [](double, double) { return 0.0; }));
  EXPECT_GE(found, 0.5);
  EXPECT_LE(found, 0.5 * (1 + kDistanceTightness));
}

TEST(MeshDistance, is_never_less_and_little_more_than_what_samples_find) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> amount(-1, 1);
  for (int round = 0; round < 12; ++round) {
    const double size = round % 2 == 0 ? 0.2 : 0.002;
    const Soup a = sheet(5, [&](double, double) { return size * amount(random); });
    const Soup b = sheet(4, [&](double, double) { return size * amount(random); });
    const double sampled =
        std::max(sampledDistance(a.view(), b.view(), 40), sampledDistance(b.view(), a.view(), 40));
    const double found = bound(a, b);
    EXPECT_GE(found, sampled);
    EXPECT_LE(found, 1.2 * sampled);
  }
}

TEST(MeshDistance, stays_tight_where_a_coarse_mesh_lies_among_very_many_triangles) {
  // Rough everywhere, so that every place could decide; farthest are the peaks.
  std::mt19937 random(5);
  std::uniform_real_distribution<double> amount(-1, 1);
  const double height = 0.0015;
  const Soup fine = sheet(400, [&](double, double) { return height * amount(random); });
  double peak = 0;
  for (const Vector3& p : fine.positions) peak = std::max(peak, std::abs(p.z));
  const double found = bound(sheet(1, [](double, double) { return 0.0; }), fine);
  EXPECT_GE(found, peak);
  EXPECT_LE(found, peak * (1 + kDistanceTightness));
}

TEST(MeshDistance, nearest_weights_find_the_nearest_point) {
  const std::array<Vector3, 3> triangle = {Vector3{0, 0, 0}, Vector3{1, 0, 0}, Vector3{0.2, 0.8, 0.1}};
  std::mt19937 random(3);
  std::uniform_real_distribution<double> place(-2, 2);
  for (int k = 0; k < 500; ++k) {
    const Vector3 p{place(random), place(random), place(random)};
    const std::array<double, 3> w = nearestWeights(triangle, p);
    EXPECT_NEAR(w[0] + w[1] + w[2], 1, 1e-12);
    EXPECT_GE(std::min({w[0], w[1], w[2]}), -1e-12);
    const double found = length(triangle[0] * w[0] + triangle[1] * w[1] + triangle[2] * w[2] - p);
    EXPECT_LE(found, distanceToTriangle(triangle, p) * (1 + 1e-9) + 1e-12);
  }
}

}  // namespace
}  // namespace deltaz
