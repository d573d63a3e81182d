#include "librender/objects/transform_planar.h"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <rapidcheck.h>

#include "tests/stress/stress_grids.h"
#include "tests/stress/true_positions.h"

namespace deltaz {
namespace {

Vector3 flatPost(const PlanarGrid& planar, const TerrainTile& tile, const GridGeometry& geometry, int i,
                 int j) {
  return planar.origin + planar.east * (i - planar.middle_column) + planar.north * (j - planar.middle_row) +
         planar.up * (geometry.metres(tile.height(i, j)) - planar.base_height);
}

// The largest distance of a valid post from the flat grid.
double largestSag(const TerrainTile& tile, const GridGeometry& geometry) {
  const PlanarGrid planar = planarGridOf(tile, geometry);
  const std::vector<LongVector> truth = truePositions(tile, geometry);
  double largest = 0;
  for (int j = 0; j < tile.rows; ++j) {
    for (int i = 0; i < tile.columns; ++i) {
      if (!tile.isValid(i, j)) continue;
      const LongVector& p = truth[static_cast<std::size_t>(j * tile.columns + i)];
      const Vector3 rounded{static_cast<double>(p.x), static_cast<double>(p.y), static_cast<double>(p.z)};
      largest = std::max(largest, length(flatPost(planar, tile, geometry, i, j) - rounded));
    }
  }
  return largest;
}

TEST(TransformPlanar, no_post_is_farther_from_the_flat_grid_than_the_bound) {
  double closest = 0;
  EXPECT_TRUE(rc::check([&] {
    SyntheticGridOptions options;
    options.south = *rc::gen::inRange(-900, 860) / 10.0;
    options.west = *rc::gen::inRange(-1800, 1800) / 10.0;
    options.spacing_latitude = {*rc::gen::inRange<std::int64_t>(1, 121), 1};
    options.spacing_longitude = {*rc::gen::inRange<std::int64_t>(1, 121), 1};
    options.columns = *rc::gen::inRange(2, 40);
    options.rows = *rc::gen::inRange(2, 40);
    options.highest = *rc::gen::inRange(-40, 9000);
    RawGrid grid = syntheticGrid(options);
    grid.header.ellipsoid = *rc::gen::element(EllipsoidShape{}, EllipsoidShape{1737400, 0},
                                              EllipsoidShape{71492000, 15.41}, EllipsoidShape{6378137, 1.5});
    const GridGeometry geometry(grid.header);
    const TerrainTile tile = wholeTile(grid);
    const double sag = largestSag(tile, geometry), bound = planarityBound(tile, geometry);
    RC_ASSERT(sag <= bound + 1e-7);
    closest = std::max(closest, sag / bound);
  }));
  std::printf("at most %.3f of the bound\n", closest);
  EXPECT_GT(closest, 0.5) << "a bound so far off says nothing";
}

TEST(TransformPlanar, the_bound_is_the_sag_of_a_tangent_plane) {
  SyntheticGridOptions options;
  options.south = -0.25;
  options.columns = options.rows = 61;
  options.lowest = options.highest = 0;
  const RawGrid grid = syntheticGrid(options);
  const GridGeometry geometry(grid.header);
  const double half = 0.25 * std::acos(-1.0) / 180 * 6378137;
  const double sag = 2 * half * half / (2 * 6378137);
  EXPECT_NEAR(planarityBound(wholeTile(grid), geometry), sag, 0.02 * sag);
  EXPECT_NEAR(largestSag(wholeTile(grid), geometry), sag, 0.02 * sag);
}

// Heights of void posts are anything; they may not move the base or the bound.
TEST(TransformPlanar, void_posts_do_not_count) {
  RawGrid grid = syntheticGrid({});
  const GridGeometry geometry(grid.header);
  const TerrainTile tile = wholeTile(grid);
  TerrainTile holed = tile;
  holed.valid[holed.index(3, 5)] = 0;
  TerrainTile wild = holed;
  wild.heights[wild.index(3, 5)] = 1 << 30;
  EXPECT_EQ(planarGridOf(wild, geometry).base, planarGridOf(holed, geometry).base);
  EXPECT_EQ(planarityBound(wild, geometry), planarityBound(holed, geometry));
}

TEST(TransformPlanar, projected_posts_lie_within_their_measured_bound) {
  const RawGrid grid = projectedGrid(100, 70, 30);
  const GridGeometry geometry(grid.header, grid.patches);
  const TerrainTile tile = wholeTile(grid);
  EXPECT_NEAR(largestSag(tile, geometry), planarityBound(tile, geometry), 1e-7);
  EXPECT_GT(planarityBound(tile, geometry), 0.1);
}

}  // namespace
}  // namespace deltaz
