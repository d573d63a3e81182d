#include "libdb/access/grid_geometry.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "tests/support/synthetic_grid.h"

namespace deltaz {
namespace {

TEST(GridGeometry, exact_spacings_hit_whole_degrees_exactly) {
  const GridAxis axis{3.0 / 3600, Rational{3, 1}, 0, 69600, 1201};
  EXPECT_EQ(postCoordinate(axis, kLongitudeOrigin, 69600), -122.0);
  EXPECT_EQ(postCoordinate(axis, kLongitudeOrigin, 69600 + 1200), -121.0);
  const GridAxis ninth{1.0 / 9 / 3600, Rational{1, 9}, 0, 0, 2};
  EXPECT_EQ(postCoordinate(ninth, kLatitudeOrigin, 90 * 3600 * 9), 0.0);
}

RC_GTEST_PROP(GridGeometry, divisions_round_down_and_up, ()) {
  const std::int64_t a = *rc::gen::inRange<std::int64_t>(-1000, 1000);
  const std::int64_t b = *rc::gen::inRange<std::int64_t>(1, 50);
  RC_ASSERT(floorDivide(a, b) * b <= a);
  RC_ASSERT((floorDivide(a, b) + 1) * b > a);
  RC_ASSERT(ceilDivide(a, b) * b >= a);
  RC_ASSERT((ceilDivide(a, b) - 1) * b < a);
}

// Whatever the area: a level's posts are those of the finer level with an even index, each of them lies in
// some node, and neighbours share their border posts.
RC_GTEST_PROP(GridGeometry, levels_nest_and_nodes_cover, ()) {
  GridHeader header = syntheticGrid().header;
  header.leaf_cells = 8;
  header.x_axis.first = *rc::gen::inRange<std::int64_t>(-100, 100);
  header.x_axis.count = *rc::gen::inRange<std::int64_t>(2, 300);
  const GridGeometry geometry(header);
  for (int level = 0; level < 6; ++level) {
    const PostRange posts = geometry.columnsAt(level);
    const PostRange finer = geometry.columnsAt(std::max(0, level - 1));
    if (level > 0) {
      RC_ASSERT(posts.begin == ceilDivide(finer.begin, 2));
      RC_ASSERT(posts.end == floorDivide(finer.end - 1, 2) + 1);
    }
    const PostRange nodes = geometry.nodeColumnsAt(level);
    RC_ASSERT(nodes.size() >= 1);
    std::int64_t next = posts.begin;
    for (std::int64_t x = nodes.begin; x < nodes.end; ++x) {
      const PostRange own = geometry.nodePosts(posts, static_cast<std::int32_t>(x));
      RC_ASSERT(own.size() <= header.leaf_cells + 1);
      if (own.size() == 0) continue;
      RC_ASSERT(own.begin <= next);
      next = std::max(next, own.end - 1);
    }
    if (posts.size() > 0) RC_ASSERT(next == posts.end - 1);
  }
}

TEST(GridGeometry, a_row_beyond_the_pole_by_rounding_stays_on_it) {
  GridHeader header = syntheticGrid().header;
  header.y_axis = {0.1, std::nullopt, 0.0000000001, 1790, 11};
  EXPECT_EQ(GridGeometry(header).latitude(1800), 90.0);
}

}  // namespace
}  // namespace deltaz
