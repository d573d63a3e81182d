#include "libdb/access/grid_locator.h"

#include <cmath>
#include <gtest/gtest.h>
#include <rapidcheck.h>

#include "tests/support/projected_grid.h"
#include "tests/support/synthetic_grid.h"

namespace deltaz {
namespace {

// A place between four posts, by bilinear interpolation of their feet.
Vector3 footBetween(const GridGeometry& geometry, std::int64_t column, std::int64_t row, double x, double y) {
  const auto foot = [&](int di, int dj) { return geometry.placeAt(column + di, row + dj).foot; };
  return (foot(0, 0) * (1 - x) + foot(1, 0) * x) * (1 - y) + (foot(0, 1) * (1 - x) + foot(1, 1) * x) * y;
}

double distanceInPosts(const GridPlace& place, std::int64_t column, std::int64_t row, double x, double y) {
  return std::hypot(static_cast<double>(place.column - column) + place.x - x,
                    static_cast<double>(place.row - row) + place.y - y);
}

TEST(GridLocator, finds_places_of_grids_of_either_kind_and_posts_exactly) {
  SyntheticGridOptions astride;  // the antimeridian
  astride.west = 179.8;
  const std::vector<RawGrid> grids = {syntheticGrid(), syntheticGrid(astride), projectedGrid()};
  for (const RawGrid& grid : grids) {
    const GridGeometry geometry(grid.header, grid.patches);
    const GridLocator locator(geometry);
    const PostRange columns = geometry.columnsAt(0), rows = geometry.rowsAt(0);
    EXPECT_TRUE(rc::check([&] {
      const std::int64_t column = *rc::gen::inRange(columns.begin, columns.end - 1);
      const std::int64_t row = *rc::gen::inRange(rows.begin, rows.end - 1);
      const std::optional<GridPlace> post = locator.locatePost(geometry, column, row);
      RC_ASSERT(post.has_value());
      RC_ASSERT(*post == (GridPlace{column, row, 0, 0}));
      const double x = *rc::gen::inRange(0, 1000) / 1000.0, y = *rc::gen::inRange(0, 1000) / 1000.0;
      const std::optional<GridPlace> place = locator.locate(footBetween(geometry, column, row, x, y));
      RC_ASSERT(place.has_value());
      // A geodetic cell is not bilinear in space: it bows by millionths of its side.
      RC_ASSERT(distanceInPosts(*place, column, row, x, y) < 1e-4);
    }));
  }
}

TEST(GridLocator, puts_what_is_nearly_on_a_line_or_a_diagonal_on_it) {
  EXPECT_EQ(GridLocator::snapped(3 + 1e-7, 5.25), (GridPlace{3, 5, 0, 0.25}));
  EXPECT_EQ(GridLocator::snapped(4 - 1e-7, -2 - 1e-8), (GridPlace{4, -2, 0, 0}));
  EXPECT_EQ(GridLocator::snapped(1.5, 2.5 + 1e-7), (GridPlace{1, 2, 0.5, 0.5}));
  EXPECT_GT(GridLocator::snapped(1.5, 2.5 + 1e-5).y, 0.5);
}

}  // namespace
}  // namespace deltaz
