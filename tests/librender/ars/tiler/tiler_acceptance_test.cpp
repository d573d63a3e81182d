// The numbers of the digest that concern one tiler; each test names its section.
#include <gtest/gtest.h>
#include <numeric>
#include <vector>

#include "librender/ars/experiments/correction_effects.h"
#include "librender/ars/experiments/random_triangles.h"
#include "librender/ars/experiments/tiler_tables.h"
#include "librender/ars/tiler/span_tiler.h"
#include "librender/ars/tiler/tiler_timing.h"
#include "librender/ars/tiler/triangle_encoder.h"
#include "librender/ars/tiler/unhindered_tiler.h"

namespace deltaz::ars {
namespace {

constexpr int kTriangles = 20000;

// Section 15: three uniform points in a square of 45.3 pixels: aU 162, aO 193, efficiency 68.8 / 83.6 %
// (+-1). The digest's sizes are those of one draw; 11/144 of the square, 156.8 pixels, is what triangles
// cover on the average, and 2.1 % of tolerance.
TEST(TilerAcceptance, section_15_uniform_triangles_in_a_square) {
  const TilerMeasurement under = measureTiler({.side = 45.3}, false, kTriangles);
  const TilerMeasurement over = measureTiler({.side = 45.3}, true, kTriangles);
  EXPECT_NEAR(under.meanSize(), 162, 0.03 * 162);
  EXPECT_NEAR(over.meanSize(), 193, 0.03 * 193);
  EXPECT_NEAR(under.efficiency(), 68.8, 1);
  EXPECT_NEAR(over.efficiency(), 83.6, 1);
}

TEST(TilerAcceptance, section_15_triangles_of_limited_area) {
  const TrianglePopulation population{.side = 82.6, .largest_area = 0.08};
  const TilerMeasurement under = measureTiler(population, false, kTriangles);
  const TilerMeasurement over = measureTiler(population, true, kTriangles);
  EXPECT_NEAR(under.meanSize(), 235, 0.02 * 235);
  EXPECT_NEAR(over.meanSize(), 282, 0.02 * 282);
  EXPECT_NEAR(under.efficiency(), 63, 1);
  EXPECT_NEAR(over.efficiency(), 81.6, 1);
}

std::vector<int> coverage(const std::vector<ProjectedTriangle>& triangles,
                          const TilerConfiguration& configuration, bool oversample) {
  std::vector<int> counts(kScreenLines * kScreenPixels);
  std::vector<PixelPacket> pixels;
  for (const ProjectedTriangle& triangle : triangles) {
    const EncodedTriangle encoded =
        encodeTriangle(triangle, configuration.numbers, {.oversample = oversample});
    pixels.clear();
    tileTriangle(setUpTriangle(encoded.variables, configuration), configuration.numbers, pixels);
    for (const PixelPacket& pixel : pixels)
      ++counts[static_cast<std::size_t>(pixel.i) * kScreenPixels + pixel.j];
  }
  return counts;
}

// Section 15: integer lattice of 16 x 16 cells of 13 pixels, undersampled: 43,681 covered, complexity 1.2307,
// no hole.
TEST(TilerAcceptance, section_15_integer_lattice) {
  const std::vector<int> counts = coverage(latticeTriangles(16, 13), {}, false);
  int covered = 0;
  for (int i = 0; i <= 208; ++i) {
    for (int j = 0; j <= 208; ++j)
      covered += counts[static_cast<std::size_t>(i * kScreenPixels + j)] > 0 ? 1 : 0;
  }
  EXPECT_EQ(covered, 43681);
  const int tiled = std::accumulate(counts.begin(), counts.end(), 0);
  EXPECT_NEAR(static_cast<double>(tiled) / covered, 1.2307, 0.00005);
  EXPECT_EQ(std::count_if(counts.begin(), counts.end(), [](int n) { return n > 0; }), covered);
}

// Ours: the top-left rule tiles each pixel once, the outermost right and lower edges not at all.
TEST(TilerAcceptance, top_left_rule_tiles_pixels_of_shared_edges_once) {
  TilerConfiguration configuration;
  configuration.corrections.top_left_rule = true;
  const std::vector<int> lattice = coverage(latticeTriangles(16, 13), configuration, false);
  for (int i = 0; i < kScreenLines; ++i) {
    for (int j = 0; j < kScreenPixels; ++j) {
      ASSERT_EQ(lattice[static_cast<std::size_t>(i * kScreenPixels + j)], i < 208 && j < 208 ? 1 : 0)
          << i << ", " << j;
    }
  }
  // A mesh whose inner vertices lie anywhere, but so that no triangle turns over.
  const std::vector<ProjectedTriangle> mesh = randomMesh(30, 10);
  const std::vector<int> once = coverage(mesh, configuration, false), twice = coverage(mesh, {}, false);
  for (int i = 0; i < kScreenLines; ++i) {
    for (int j = 0; j < kScreenPixels; ++j) {
      const auto at = static_cast<std::size_t>(i * kScreenPixels + j);
      ASSERT_EQ(once[at], i < 300 && j < 300 ? 1 : 0) << i << ", " << j;
    }
  }
  EXPECT_GT(std::accumulate(twice.begin(), twice.end(), 0), 90000 * 1.01);
}

// Section 15: 121.803 pixels at 70.602 %, oversampled: 0.7 + 0.1 x 172.52 = 17.95 us a triangle.
TEST(TilerAcceptance, section_15_time_of_a_triangle) {
  EXPECT_NEAR(static_cast<double>(tilingTime(0)) + 172.52 * static_cast<double>(kSamplePixel), 17.95e6,
              0.003e6);
  EXPECT_EQ(triangleTime(true, 172), 17900 * kNanosecond);
  EXPECT_EQ(triangleTime(true, 173), 18000 * kNanosecond);
  // Section 15: set-up bounds, 102,564 and 115,875 triangles a second.
  EXPECT_NEAR(1e12 / static_cast<double>(triangleTime(false, 10)), 102564, 0.5);
  EXPECT_NEAR(1e12 / static_cast<double>(triangleTime(true, 10)), 115875, 0.5);
  // Section 6.4: crossovers.
  EXPECT_EQ(triangleTime(true, 79), kOversampleSetUp);
  EXPECT_GT(triangleTime(true, 80), kOversampleSetUp);
  EXPECT_EQ(triangleTime(false, 90), kUndersampleSetUp);
  EXPECT_GT(triangleTime(false, 91), kUndersampleSetUp);
}

TEST(TilerAcceptance, the_slower_stage_decides_and_the_queue_evens_out) {
  UnhinderedTiler bound_by_set_up, bound_by_tiling, mixed;
  for (int n = 0; n < 1000; ++n) {
    bound_by_set_up.add(true, 10);
    bound_by_tiling.add(true, 200);
    mixed.add(true, n % 2 == 0 ? 150 : 10);
  }
  EXPECT_EQ(bound_by_set_up.end(), 1000 * kOversampleSetUp + tilingTime(10));
  EXPECT_EQ(bound_by_tiling.end(), kOversampleSetUp + 1000 * tilingTime(200));
  // 15.7 and 1.7 us: 8.7 on the average, just above set-up.
  EXPECT_NEAR(static_cast<double>(mixed.end()), 1000 * 8.7e6, 20e6);
  // With triangles long in a row the queue fills, and set-up waits.
  UnhinderedTiler runs;
  for (int n = 0; n < 1000; ++n) runs.add(true, n / 50 % 2 == 0 ? 150 : 10);
  EXPECT_GT(static_cast<double>(runs.end()), 1000 * 11e6);
}

}  // namespace
}  // namespace deltaz::ars
