#include "libdb/check/mesh_deviation.h"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <iostream>
#include <limits>
#include <numbers>
#include <random>

#include "libdb/access/vector3.h"

namespace deltaz {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

Vector3 at(const ModelMesh& mesh, std::uint32_t index) {
  const auto& v = mesh.vertices[index];
  return {static_cast<double>(v[0]), static_cast<double>(v[1]), static_cast<double>(v[2])};
}

// The distance of a point from a triangle by search: over lines parallel to one edge it is a convex function.
// Slow, and nothing like the code under test.
double distanceTo(const Vector3& p, const Vector3& a, const Vector3& b, const Vector3& c) {
  const auto to_line = [&](double s) {
    const Vector3 from = a + (b - a) * s, along = (c - a) * (1 - s);
    const double size = dot(along, along);
    const double t = size > 0 ? std::clamp(dot(p - from, along) / size, 0.0, 1.0) : 0.0;
    return length(p - (from + along * t));
  };
  double low = 0, high = 1;
  for (int k = 0; k < 60; ++k) {
    const double third = (high - low) / 3;
    if (to_line(low + third) < to_line(high - third)) {
      high -= third;
    } else {
      low += third;
    }
  }
  return to_line((low + high) / 2);
}

// The largest distance of points of `from` from `to`: `count` random points a triangle.
double sampled(const ModelMesh& from, const ModelMesh& to, int count, std::mt19937& random) {
  std::uniform_real_distribution<double> unit(0, 1);
  double largest = 0;
  for (const auto& triangle : from.triangles) {
    for (int k = 0; k < count; ++k) {
      double u = unit(random), v = unit(random);
      if (u + v > 1) u = 1 - u, v = 1 - v;
      const Vector3 a = at(from, triangle[0]);
      const Vector3 p = a + (at(from, triangle[1]) - a) * u + (at(from, triangle[2]) - a) * v;
      double nearest = kInfinity;
      for (const auto& other : to.triangles)
        nearest = std::min(nearest, distanceTo(p, at(to, other[0]), at(to, other[1]), at(to, other[2])));
      largest = std::max(largest, nearest);
    }
  }
  return largest;
}

// A square of side 1 in n x n cells, its inner vertices raised by `height`.
ModelMesh square(int n, float height) {
  ModelMesh mesh;
  for (int j = 0; j <= n; ++j) {
    for (int i = 0; i <= n; ++i) {
      const bool inner = i > 0 && j > 0 && i < n && j < n;
      mesh.vertices.push_back({static_cast<float>(i) / static_cast<float>(n),
                               static_cast<float>(j) / static_cast<float>(n), inner ? height : 0.0f});
    }
  }
  for (int j = 0; j < n; ++j) {
    for (int i = 0; i < n; ++i) {
      const auto v = static_cast<std::uint32_t>(j * (n + 1) + i), up = static_cast<std::uint32_t>(n + 1);
      mesh.triangles.push_back({v, v + 1, v + up + 1});
      mesh.triangles.push_back({v, v + up + 1, v + up});
    }
  }
  return mesh;
}

ModelMesh randomMesh(std::mt19937& random, std::uint32_t triangles) {
  std::uniform_real_distribution<float> place(-1, 1);
  ModelMesh mesh;
  for (std::uint32_t t = 0; t < triangles; ++t) {
    for (std::uint32_t k = 0; k < 3; ++k)
      mesh.vertices.push_back({place(random), place(random), place(random)});
    mesh.triangles.push_back({3 * t, 3 * t + 1, 3 * t + 2});
  }
  return mesh;
}

// As near as it gets: neither threshold is ever passed.
MeshDeviation exactly(const ModelMesh& a, const ModelMesh& b, double near) {
  return measureDeviation(a, b, near * 0.999, near * 1.001);
}

TEST(MeshDeviation, known_distances_are_found) {
  const ModelMesh flat = square(1, 0);
  // A ridge over one cell of 8 x 8, and back: largest at the inner vertices, seen from the finer mesh.
  EXPECT_NEAR(exactly(square(8, 0.25f), flat, 0.25).sampled, 0.25, 1e-12);
  ModelMesh moved = flat;
  for (auto& vertex : moved.vertices) vertex[2] += 0.125f;
  const MeshDeviation parallel = exactly(flat, moved, 0.125);
  EXPECT_NEAR(parallel.sampled, 0.125, 1e-12);
  EXPECT_LE(parallel.bound, 0.125 * 1.001) << "large parallel faces need no fine parts";
  const MeshDeviation same = measureDeviation(flat, square(16, 0), 0, 1e-9);
  EXPECT_LE(same.sampled, 1e-12);
  EXPECT_LE(same.bound, 1e-9);
}

// What lies beside a mesh counts in both directions: the small one lies on the large one, not the other way
// round.
TEST(MeshDeviation, is_two_sided) {
  ModelMesh small = square(1, 0);
  for (auto& vertex : small.vertices) vertex = {vertex[0] / 2, vertex[1] / 2, 0};
  const double corner = std::numbers::sqrt2 / 2;
  EXPECT_NEAR(exactly(square(4, 0), small, corner).sampled, corner, 1e-12);
  EXPECT_NEAR(exactly(small, square(4, 0), corner).sampled, corner, 1e-12);
}

TEST(MeshDeviation, agrees_with_random_samples_by_brute_force) {
  std::mt19937 random(7);
  double least_ratio = 1;
  for (int trial = 0; trial < 6; ++trial) {
    const ModelMesh a = randomMesh(random, 4), b = randomMesh(random, 5);
    const double dense = std::max(sampled(a, b, 200, random), sampled(b, a, 200, random));
    // Thresholds that are never met together: refined until the two bounds meet.
    MeshDeviation found = measureDeviation(a, b, 0, kInfinity);
    for (int k = 0; k < 40 && found.bound > found.sampled * 1.01; ++k) {
      const double middle = (found.sampled + found.bound) / 2;
      const MeshDeviation next = measureDeviation(a, b, middle, middle);
      found = {std::max(found.sampled, next.sampled), std::min(found.bound, next.bound)};
    }
    EXPECT_LE(found.bound, found.sampled * 1.0101);
    EXPECT_GE(found.bound, dense * (1 - 1e-6)) << "a sample lies beyond the bound";
    EXPECT_LE(dense * 0.999, found.bound);
    EXPECT_GE(dense, found.sampled * 0.8) << "200 samples a triangle come near";
    least_ratio = std::min(least_ratio, dense / found.sampled);
  }
  std::cout << "[  FIGURE  ] brute force reached " << least_ratio << " of the distance at least\n";
}

TEST(MeshDeviation, bounds_hold_whatever_is_asked) {
  std::mt19937 random(11);
  for (int trial = 0; trial < 20; ++trial) {
    const ModelMesh a = randomMesh(random, 6), b = randomMesh(random, 6);
    for (const double low : {0.0, 0.3, 1.0}) {
      for (const double high : {0.3, 1.0, 3.0}) {
        if (low > high) continue;
        const MeshDeviation found = measureDeviation(a, b, low, high);
        EXPECT_LE(found.sampled, found.bound * (1 + 1e-12));
        const bool decided =
            found.sampled > high || found.bound <= low || (found.bound <= high && found.sampled >= low);
        EXPECT_TRUE(decided) << low << " " << high << ": " << found.sampled << " " << found.bound;
      }
    }
  }
}

TEST(MeshDeviation, flat_triangles_and_points_are_no_trouble) {
  ModelMesh line = square(1, 0), point = line;
  line.triangles = {{0, 1, 0}};
  point.triangles = {{3, 3, 3}};
  EXPECT_NEAR(exactly(line, point, std::sqrt(2.0)).sampled, std::sqrt(2.0), 1e-12);
  EXPECT_NEAR(exactly(point, square(1, 0), std::sqrt(2.0)).sampled, std::sqrt(2.0), 1e-12);
}

}  // namespace
}  // namespace deltaz
