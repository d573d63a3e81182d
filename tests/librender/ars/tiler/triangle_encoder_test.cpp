#include "librender/ars/tiler/triangle_encoder.h"

#include <cmath>
#include <gtest/gtest.h>
#include <limits>

#include "librender/ars/experiments/random_triangles.h"
#include "librender/ars/words/triangle_words.h"
#include "tests/librender/ars/tiler/mixed_triangles.h"

namespace deltaz::ars {
namespace {

const NumberProfile kTable8;

// A plane with values that are exact in the formats.
ProjectedTriangle planarTriangle(std::array<std::array<double, 2>, 3> points) {
  ProjectedTriangle triangle;
  for (std::size_t k = 0; k < 3; ++k) {
    const double i = points[k][0], j = points[k][1];
    triangle[k] = {.i = i, .j = j, .depth = 0.25 + i / 1024 - j / 4096, .color = 8 + i / 2 + j / 4};
  }
  return triangle;
}

TEST(TriangleEncoder, sorts_on_i_and_names_the_corner) {
  const std::array<std::array<double, 2>, 3> points{{{40, 12}, {10.5, 10.25}, {20, 60}}};
  for (const auto& order : {std::array{0, 1, 2}, {0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}}) {
    std::array<std::array<double, 2>, 3> shuffled{};
    for (std::size_t k = 0; k < 3; ++k) shuffled[k] = points[static_cast<std::size_t>(order[k])];
    const TriangleVariables v = encodeTriangle(planarTriangle(shuffled), kTable8, {}).variables;
    EXPECT_EQ(v.vertices[0], (TriangleVariables::Vertex{.i = 672, .j = 656}));
    EXPECT_EQ(v.vertices[1], (TriangleVariables::Vertex{.i = 1280, .j = 3840}));
    EXPECT_EQ(v.vertices[2], (TriangleVariables::Vertex{.i = 2560, .j = 768}));
    EXPECT_EQ(v.corner, Corner::kUpperLeft);
  }
}

TEST(TriangleEncoder, every_corner_is_found) {
  const std::array<std::pair<std::array<std::array<double, 2>, 3>, Corner>, 4> cases{{
      {{{{1, 1}, {9, 5}, {5, 9}}}, Corner::kUpperLeft},
      {{{{1, 9}, {9, 5}, {5, 1}}}, Corner::kUpperRight},
      {{{{9, 1}, {1, 5}, {5, 9}}}, Corner::kLowerLeft},
      {{{{9, 9}, {1, 5}, {5, 1}}}, Corner::kLowerRight},
  }};
  for (const auto& [points, corner] : cases)
    EXPECT_EQ(encodeTriangle(planarTriangle(points), kTable8, {}).variables.corner, corner);
}

// Digest section 0, 5: D0 and C0 are values at the corner vertex rounded to the pixel, not at the vertex.
TEST(TriangleEncoder, planes_start_at_the_corner_rounded_to_the_pixel) {
  const EncodedTriangle e =
      encodeTriangle(planarTriangle({{{10.5, 10.25}, {20, 60}, {40, 12}}}), kTable8, {});
  EXPECT_EQ(e.variables.depth, 0.25 + 11.0 / 1024 - 10.0 / 4096);
  EXPECT_EQ(e.variables.depth_i, 1.0 / 1024);
  EXPECT_EQ(e.variables.depth_j, -1.0 / 4096);
  EXPECT_EQ(e.variables.color, 8 + 5.5 + 2.5);
  EXPECT_EQ(e.variables.color_i, 0.5);
  EXPECT_EQ(e.variables.color_j, 0.25);
  EXPECT_EQ(e.supplement.least_depth, 0.25 + 20.0 / 1024 - 60.0 / 4096);
  EXPECT_EQ(e.supplement.greatest_depth, 0.25 + 40.0 / 1024 - 12.0 / 4096);
}

TEST(TriangleEncoder, clipped_triangles_share_the_planes_of_their_original) {
  const ProjectedTriangle original = planarTriangle({{{10, 10}, {200, 60}, {40, 300}}});
  ProjectedTriangle clipped = original;
  clipped[1].i = 100;  // its depth and colour no longer matter
  clipped[1].j = 35;
  const EncodedTriangle e = encodeTriangle(clipped, planesOf(original, 2), kTable8, {});
  EXPECT_EQ(e.variables.depth, 0.25 + 10.0 / 1024 - 10.0 / 4096);
  EXPECT_EQ(e.variables.depth_i, 1.0 / 1024);
}

TEST(TriangleEncoder, any_input_becomes_a_tileable_triangle) {
  constexpr double kNothing = std::numeric_limits<double>::quiet_NaN(),
                   kInfinity = std::numeric_limits<double>::infinity();
  const std::array<double, 10> values = {0,   -0.5,   -0.51,     511.49,   511.5,
                                         600, -1e300, kInfinity, kNothing, 17.3};
  RandomNumbers random(4);
  for (int n = 0; n < 20000; ++n) {
    ProjectedTriangle triangle;
    for (ProjectedVertex& vertex : triangle) {
      for (double* value : {&vertex.i, &vertex.j, &vertex.depth, &vertex.color})
        *value = values[random.below(values.size())];
    }
    for (const int bits : {0, 1, 6, 12}) {
      const NumberProfile numbers = withVertexFractionBits(kTable8, bits);
      const TriangleVariables v = encodeTriangle(triangle, numbers, {.oversample = n % 2 == 0}).variables;
      ASSERT_TRUE(isTileable(v, bits));
      for (const double value : {v.depth, v.depth_i, v.depth_j, v.color, v.color_i, v.color_j})
        ASSERT_TRUE(std::isfinite(value));
    }
  }
}

TEST(TriangleEncoder, numbers_are_those_of_the_formats) {
  RandomNumbers random(5);
  for (int n = 0; n < 5000; ++n) {
    const TriangleVariables v = encodeTriangle(mixedTriangle(random), kTable8, {}).variables;
    for (const double value : {v.depth, v.depth_i, v.depth_j})
      ASSERT_EQ(kDepthPlaneFormat.round(value, Rounding::kNearest), value);
    for (const double value : {v.color, v.color_i, v.color_j})
      ASSERT_EQ(kColorFormat.round(value, Rounding::kNearest), value);
  }
}

}  // namespace
}  // namespace deltaz::ars
