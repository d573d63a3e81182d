#include "libdb/build/mesh_overlay.h"

#include <algorithm>
#include <gtest/gtest.h>

namespace deltaz {
namespace {

struct Soup {
  std::vector<Vector3> positions;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  TriangleView view() const { return {positions, triangles}; }
};

// Over the unit square, waved so little that it lies over all of it seen from above.
Soup sheet(std::uint32_t steps) {
  Soup soup;
  for (std::uint32_t j = 0; j <= steps; ++j) {
    for (std::uint32_t i = 0; i <= steps; ++i) {
      soup.positions.push_back(
          {static_cast<double>(i) / steps, static_cast<double>(j) / steps, (i * 7 + j * 5) % 3 * 0.01});
    }
  }
  for (std::uint32_t j = 0; j < steps; ++j) {
    for (std::uint32_t i = 0; i < steps; ++i) {
      const std::uint32_t a = j * (steps + 1) + i, c = a + steps + 1;
      soup.triangles.push_back({a, a + 1, c + 1});
      // Which side of a triangle is its front does not matter.
      soup.triangles.push_back({c, c + 1, a});
    }
  }
  return soup;
}

double areaOf(const std::vector<Vector3>& polygon) {
  double area = 0;
  for (std::size_t k = 2; k < polygon.size(); ++k)
    area += length(cross(polygon[k - 1] - polygon[0], polygon[k] - polygon[0])) / 2;
  return area;
}

const std::array<Vector3, 3> kPiece = {Vector3{0.11, 0.12, 0.3}, Vector3{0.87, 0.21, 0.3},
                                       Vector3{0.43, 0.9, 0.3}};

// The triangle of the sheet that lies over the piece's middle.
std::size_t middleOf(const Soup& soup) {
  for (std::size_t t = 0; t < soup.triangles.size(); ++t) {
    const auto corners = soup.view().corners(t);
    bool inside = true;
    const Vector3 up = {0, 0, cross(corners[1] - corners[0], corners[2] - corners[0]).z};
    for (std::size_t k = 0; k < 3; ++k) {
      const Vector3 p{0.47, 0.41, corners[k].z};
      if (dot(cross(corners[(k + 1) % 3] - corners[k], p - corners[k]), up) < 0) inside = false;
    }
    if (inside) return t;
  }
  return 0;
}

TEST(MeshOverlay, parts_cover_the_piece_and_lie_under_their_triangles) {
  for (const std::uint32_t steps : {1u, 3u, 40u}) {
    const Soup soup = sheet(steps);
    MeshOverlay overlay(soup.view());
    const std::vector<OverlayPart> parts = overlay.over(kPiece, middleOf(soup));
    ASSERT_FALSE(parts.empty()) << steps;
    double sum = 0;
    for (const OverlayPart& part : parts) {
      sum += areaOf(part.polygon);
      const auto corners = soup.view().corners(part.triangle);
      for (const Vector3& p : part.polygon) {
        EXPECT_NEAR(p.z, 0.3, 1e-12);
        for (const double Vector3::*axis : {&Vector3::x, &Vector3::y}) {
          EXPECT_GE(p.*axis, std::min({corners[0].*axis, corners[1].*axis, corners[2].*axis}) - 1e-12);
          EXPECT_LE(p.*axis, std::max({corners[0].*axis, corners[1].*axis, corners[2].*axis}) + 1e-12);
        }
      }
    }
    EXPECT_NEAR(sum, areaOf({kPiece.begin(), kPiece.end()}), 1e-12) << steps;
  }
}

TEST(MeshOverlay, a_hole_within_the_piece_is_no_cover) {
  Soup soup = sheet(9);
  const std::size_t first = middleOf(soup);
  soup.triangles.erase(soup.triangles.begin() + static_cast<std::ptrdiff_t>(first) + 4);
  EXPECT_TRUE(MeshOverlay(soup.view()).over(kPiece, first).empty());
}

TEST(MeshOverlay, a_mesh_that_turns_over_within_the_piece_is_no_cover) {
  Soup soup = sheet(9);
  const std::size_t first = middleOf(soup);
  // One vertex pulled over its neighbours.
  soup.positions[soup.triangles[first][0]].x += 0.2;
  EXPECT_TRUE(MeshOverlay(soup.view()).over(kPiece, first).empty());
}

TEST(MeshOverlay, a_mesh_beside_the_piece_or_smaller_than_it_is_no_cover) {
  const Soup soup = sheet(4);
  std::array<Vector3, 3> moved = kPiece;
  for (Vector3& corner : moved) corner = corner + Vector3{0.3, 0, 0};
  EXPECT_TRUE(MeshOverlay(soup.view()).over(moved, middleOf(soup)).empty());
  EXPECT_TRUE(MeshOverlay(soup.view()).over(kPiece, soup.triangles.size() - 1).empty())
      << "the last triangle is not over it";
}

}  // namespace
}  // namespace deltaz
