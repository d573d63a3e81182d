#include "librender/ars/experiments/width_sweep.h"

#include <cmath>
#include <gtest/gtest.h>
#include <map>

#include "librender/ars/experiments/correction_effects.h"

namespace deltaz::ars {
namespace {

using Points = std::map<int, WidthPoint>;

Points sweep(const std::string& width) {
  static const std::vector<WidthPoint> kPoints = [] {
    const std::vector<ProjectedTriangle> terrain = grazingTerrain();
    return sweepWidths(std::span(terrain).first(std::min<std::size_t>(terrain.size(), 1500)));
  }();
  Points points;
  for (const WidthPoint& point : kPoints) {
    if (point.width == width) points[point.bits] = point;
  }
  return points;
}

// Digest 6.1: the tolerance is the bound of the rounding, whatever the width; each bit halves what it adds.
TEST(WidthSweep, vertices_of_any_width_lose_no_pixel) {
  const Points points = sweep("vertex fraction");
  for (const auto& [bits, point] : points) EXPECT_EQ(point.error.missing, 0) << bits << " bits";
  for (const int bits : {1, 2, 3, 4, 5, 6, 7})
    EXPECT_NEAR(points.at(bits).error.extra / points.at(bits + 1).error.extra, 2, 0.5) << bits << " bits";
  EXPECT_EQ(points.at(7).triangle_bits - points.at(6).triangle_bits, 6);
  EXPECT_TRUE(points.at(6).table_8);
  EXPECT_FALSE(points.at(7).table_8);
}

// Digest section 1, Table 2: 2^-(M + 1) of the depth, as long as the planes are finer.
TEST(WidthSweep, memory_depth_is_as_far_off_as_its_last_bit_allows) {
  const Points points = sweep("depth mantissa");
  for (const int bits : {3, 7, 11, 13, 15}) {
    const double half_bit = std::ldexp(1.0, -bits - 1);
    EXPECT_LE(points.at(bits).error.depth_largest, 1.05 * half_bit) << bits << " bits";
    EXPECT_GE(points.at(bits).error.depth_largest, 0.9 * half_bit) << bits << " bits";
  }
  EXPECT_EQ(points.at(19).pixel_bits - points.at(15).pixel_bits, 4);
  EXPECT_EQ(points.at(27).error.extra, points.at(3).error.extra);
}

TEST(WidthSweep, wider_colours_and_planes_are_nearer) {
  const Points colors = sweep("colour mantissa"), planes = sweep("plane mantissa");
  for (auto at = std::next(colors.begin()); at != colors.end() && at->first <= 12; ++at)
    EXPECT_LT(at->second.error.color_mean, std::prev(at)->second.error.color_mean) << at->first << " bits";
  // Half a code is what the integer costs in any format.
  EXPECT_NEAR(colors.at(16).error.color_mean, 0.25, 0.01);
  EXPECT_LE(colors.at(16).error.color_largest, 0.55);
  for (auto at = std::next(planes.begin()); at != planes.end() && at->first <= 20; ++at)
    EXPECT_LT(at->second.error.depth_mean, std::prev(at)->second.error.depth_mean) << at->first << " bits";
}

}  // namespace
}  // namespace deltaz::ars
