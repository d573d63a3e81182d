// Coverage errors against definitions worked out by hand and against distances found by trying everything.
#include "libdb/build/coverage_error.h"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <optional>
#include <rapidcheck/gtest.h>
#include <vector>

#include "formats/node_file.h"
#include "libdb/access/plan_shape.h"
#include "tests/support/projected_grid.h"
#include "tests/support/synthetic_grid.h"

namespace deltaz {
namespace {

// A grid at the equator whose first post opens node (x, y) = (0, 0) of every level it is asked about.
RawGrid gridOf(std::int64_t columns, std::int64_t rows) {
  SyntheticGridOptions options;
  options.columns = columns;
  options.rows = rows;
  options.spacing_latitude = options.spacing_longitude = {1, 1};
  RawGrid grid = syntheticGrid(options);
  grid.header.leaf_cells = 8;
  grid.header.x_axis.first = 1 << 19;
  grid.header.y_axis.first = 90 * 3600 / 256 * 256;
  grid.valid.assign(grid.heights.size(), 1);
  return grid;
}

void erase(RawGrid& grid, std::int64_t column, std::int64_t row) {
  grid.valid[static_cast<std::size_t>(row * grid.header.x_axis.count + column)] = 0;
}

double metresAt(const RawGrid& grid, int level) {
  const GridGeometry geometry(grid.header);
  const std::int64_t span = std::int64_t{grid.header.leaf_cells} << level;
  const std::uint32_t units = coverageError(
      grid, geometry, level, static_cast<std::int32_t>(floorDivide(grid.header.x_axis.first, span)),
      static_cast<std::int32_t>(floorDivide(grid.header.y_axis.first, span)),
      std::count(grid.valid.begin(), grid.valid.end(), 0) > 0);
  return units == kUnknownError ? INFINITY : units * kErrorUnit;
}

CellSize cellOf(const RawGrid& grid) {
  const GridGeometry geometry(grid.header);
  return largestCell(geometry, geometry.columnsAt(0), geometry.rowsAt(0));
}

TEST(CoverageError, a_full_node_has_none) {
  const RawGrid grid = gridOf(17, 17);
  EXPECT_EQ(metresAt(grid, 1), 0);
}

TEST(CoverageError, an_edge_that_ends_short_counts_with_the_farthest_corner) {
  // Level 2 reaches post 12 of 15 columns and post 12 of 14 rows.
  const RawGrid grid = gridOf(16, 15);
  const CellSize cell = cellOf(grid);
  EXPECT_NEAR(cell.width, 30.92, 0.01);
  EXPECT_NEAR(cell.height, 30.715, 0.01);
  EXPECT_NEAR(metresAt(grid, 2), std::hypot(3 * cell.width, 2 * cell.height), kErrorUnit);
}

TEST(CoverageError, an_area_narrower_than_a_cell_is_unknown) {
  EXPECT_EQ(metresAt(gridOf(8, 3), 2), INFINITY);
}

TEST(CoverageError, a_single_void_widens_at_coarser_levels) {
  // One void post that stands in every level: six triangles are missing at each.
  RawGrid grid = gridOf(33, 33);
  erase(grid, 16, 16);
  const CellSize cell = cellOf(grid);
  for (int level = 1; level <= 2; ++level) {
    // The farthest point of what is lost from what is drawn: a fine post beside the void.
    const double metres = metresAt(grid, level);
    const double step = std::ldexp(1.0, level);
    EXPECT_GT(metres, (step / 2 - 1) * cell.height);
    EXPECT_LT(metres, step * cell.height + cell.diagonal());
  }
}

TEST(CoverageError, a_hole_between_coarse_posts_is_drawn_over) {
  RawGrid grid = gridOf(33, 33);
  for (std::int64_t row = 9; row < 16; ++row) {
    for (std::int64_t column = 9; column < 16; ++column) erase(grid, column, row);
  }
  const CellSize cell = cellOf(grid);
  // Post (12, 12), the middle of the hole, lies four cells from its rim.
  EXPECT_GE(metresAt(grid, 3), 4 * cell.height);
  EXPECT_LE(metresAt(grid, 3), 4 * cell.height + cell.diagonal());
}

TEST(CoverageError, an_island_that_vanishes_counts_with_its_diameter) {
  RawGrid grid = gridOf(65, 65);
  // Land west of column 8 and, far from it, an island of 3 x 2 cells without any post of level 2.
  for (std::int64_t row = 0; row < 65; ++row) {
    for (std::int64_t column = 9; column < 65; ++column) {
      const bool island = column >= 41 && column <= 43 && row >= 41 && row <= 43;
      if (!island) erase(grid, column, row);
    }
  }
  const CellSize cell = cellOf(grid);
  EXPECT_NEAR(metresAt(grid, 3), std::hypot(2 * cell.width, 2 * cell.height), 0.01);
}

TEST(CoverageError, a_facet_over_nothing_counts_with_its_diameter) {
  // Level 2 has valid posts where the full resolution has no two valid neighbours.
  RawGrid grid = gridOf(33, 33);
  for (std::int64_t row = 0; row < 33; ++row) {
    for (std::int64_t column = 12; column < 33; ++column) {
      const bool alone = column == 20 && (row == 20 || row == 24);
      const bool third = column == 24 && row == 24;
      if (!alone && !third) erase(grid, column, row);
    }
  }
  const CellSize cell = cellOf(grid);
  EXPECT_NEAR(metresAt(grid, 2), std::hypot(4 * cell.width, 4 * cell.height), 0.01);
}

TEST(CoverageError, nothing_valid_has_none_and_isolated_posts_draw_nothing) {
  RawGrid grid = gridOf(17, 17);
  std::fill(grid.valid.begin(), grid.valid.end(), 0);
  EXPECT_EQ(metresAt(grid, 1), 0);
  grid.valid[5] = 1;
  EXPECT_EQ(metresAt(grid, 1), 0);
}

// Trying everything: points on a lattice four times as dense as the posts, distances to every triangle.
double bruteForce(const RawGrid& grid, int level) {
  const CellSize cell = cellOf(grid);
  const std::int64_t columns = grid.header.x_axis.count, rows = grid.header.y_axis.count;
  struct Point {
    double x, y;
  };
  struct Tri {
    Point a, b, c;
    std::vector<std::size_t> touching;
    int part = -1;
  };
  const auto trianglesOf = [&](std::int64_t step) {
    std::vector<Tri> triangles;
    const auto ok = [&](std::int64_t c, std::int64_t r) {
      return c < columns && r < rows && grid.isValid(c, r);
    };
    const auto point = [&](std::int64_t c, std::int64_t r) {
      return Point{static_cast<double>(c) * cell.width, static_cast<double>(r) * cell.height};
    };
    for (std::int64_t r = 0; r + step < rows; r += step) {
      for (std::int64_t c = 0; c + step < columns; c += step) {
        if (!ok(c, r) || !ok(c + step, r + step)) continue;
        if (ok(c + step, r))
          triangles.push_back({point(c, r), point(c + step, r), point(c + step, r + step), {}});
        if (ok(c, r + step))
          triangles.push_back({point(c, r), point(c + step, r + step), point(c, r + step), {}});
      }
    }
    // Components by shared corners.
    const auto shares = [](const Tri& s, const Tri& t) {
      for (const Point& p : {s.a, s.b, s.c}) {
        for (const Point& q : {t.a, t.b, t.c}) {
          if (p.x == q.x && p.y == q.y) return true;
        }
      }
      return false;
    };
    int parts = 0;
    for (std::size_t i = 0; i < triangles.size(); ++i) {
      if (triangles[i].part >= 0) continue;
      std::vector<std::size_t> stack = {i};
      triangles[i].part = parts;
      while (!stack.empty()) {
        const std::size_t t = stack.back();
        stack.pop_back();
        for (std::size_t k = 0; k < triangles.size(); ++k) {
          if (triangles[k].part >= 0 || !shares(triangles[t], triangles[k])) continue;
          triangles[k].part = parts;
          stack.push_back(k);
        }
      }
      ++parts;
    }
    return triangles;
  };
  const auto side = [](const Point& p, const Point& q, const Point& r) {
    return (q.x - p.x) * (r.y - p.y) - (q.y - p.y) * (r.x - p.x);
  };
  const auto toSegment = [](const Point& p, const Point& a, const Point& b) {
    const double dx = b.x - a.x, dy = b.y - a.y;
    const double t = std::clamp(((p.x - a.x) * dx + (p.y - a.y) * dy) / (dx * dx + dy * dy), 0.0, 1.0);
    return std::hypot(p.x - a.x - t * dx, p.y - a.y - t * dy);
  };
  const auto distance = [&](const Point& p, const Tri& t) {
    if (side(t.a, t.b, p) >= -1e-9 && side(t.b, t.c, p) >= -1e-9 && side(t.c, t.a, p) >= -1e-9) return 0.0;
    return std::min({toSegment(p, t.a, t.b), toSegment(p, t.b, t.c), toSegment(p, t.c, t.a)});
  };
  const std::vector<Tri> fine = trianglesOf(1), coarse = trianglesOf(std::int64_t{1} << level);
  if (coarse.empty()) return fine.empty() ? 0 : INFINITY;
  const auto oneSided = [&](const std::vector<Tri>& from, const std::vector<Tri>& to) {
    double largest = 0;
    int parts = 0;
    for (const Tri& t : from) parts = std::max(parts, t.part + 1);
    for (int part = 0; part < parts; ++part) {
      bool matched = false;
      double farthest = 0, diameter = 0;
      std::vector<Point> corners;
      for (const Tri& t : from) {
        if (t.part != part) continue;
        for (const Point& p : {t.a, t.b, t.c}) corners.push_back(p);
        const Point middle{(t.a.x + t.b.x + t.c.x) / 3, (t.a.y + t.b.y + t.c.y) / 3};
        // Fine triangles nest in coarse ones, so a match shows at the middle of the finer.
        for (const Tri& other : to) {
          const Point theirs{(other.a.x + other.b.x + other.c.x) / 3,
                             (other.a.y + other.b.y + other.c.y) / 3};
          if (distance(middle, other) == 0 || distance(theirs, t) == 0) matched = true;
        }
        constexpr int kDense = 8;
        for (int i = 0; i <= kDense; ++i) {
          for (int j = 0; i + j <= kDense; ++j) {
            const double u = double(i) / kDense, v = double(j) / kDense;
            const Point p{t.a.x + u * (t.b.x - t.a.x) + v * (t.c.x - t.a.x),
                          t.a.y + u * (t.b.y - t.a.y) + v * (t.c.y - t.a.y)};
            double nearest = INFINITY;
            for (const Tri& other : to) nearest = std::min(nearest, distance(p, other));
            farthest = std::max(farthest, nearest);
          }
        }
      }
      for (const Point& p : corners) {
        for (const Point& q : corners) diameter = std::max(diameter, std::hypot(p.x - q.x, p.y - q.y));
      }
      largest = std::max(largest, matched ? farthest : diameter);
    }
    return largest;
  };
  return std::max(oneSided(fine, coarse), oneSided(coarse, fine));
}

RC_GTEST_PROP(CoverageError, is_never_too_small_and_too_large_by_a_fine_cell_at_most, ()) {
  RawGrid grid = gridOf(*rc::gen::inRange<std::int64_t>(5, 14), *rc::gen::inRange<std::int64_t>(5, 14));
  // Discs of voids, as lakes and frayed edges are.
  const int holes = *rc::gen::inRange(0, 5);
  for (int hole = 0; hole < holes; ++hole) {
    const auto x = *rc::gen::inRange<std::int64_t>(-2, 14), y = *rc::gen::inRange<std::int64_t>(-2, 14);
    const auto radius = *rc::gen::inRange<std::int64_t>(0, 5);
    for (std::int64_t row = 0; row < grid.header.y_axis.count; ++row) {
      for (std::int64_t column = 0; column < grid.header.x_axis.count; ++column) {
        if ((column - x) * (column - x) + (row - y) * (row - y) <= radius * radius) erase(grid, column, row);
      }
    }
  }
  for (const int level : {1, 2}) {
    const double stored = metresAt(grid, level), true_distance = bruteForce(grid, level);
    if (std::isinf(true_distance)) {
      RC_ASSERT(std::isinf(stored));
      continue;
    }
    RC_ASSERT(stored >= true_distance - 1e-9);
    RC_ASSERT(stored <= true_distance + cellOf(grid).diagonal() + 2 * kErrorUnit);
  }
}

TEST(LargestCell, is_no_smaller_than_any_cell) {
  const auto expectBound = [](const RawGrid& grid) {
    const GridGeometry geometry(grid.header, grid.patches);
    const PostRange columns = geometry.columnsAt(0), rows = geometry.rowsAt(0);
    const CellSize cell = largestCell(geometry, columns, rows);
    double width = 0, height = 0;
    for (std::int64_t row = rows.begin; row + 1 < rows.end; ++row) {
      for (std::int64_t column = columns.begin; column + 1 < columns.end; ++column) {
        const Vector3 here = geometry.placeAt(column, row).foot;
        width = std::max(width, length(geometry.placeAt(column + 1, row).foot - here));
        height = std::max(height, length(geometry.placeAt(column, row + 1).foot - here));
      }
    }
    EXPECT_GE(cell.width, width);
    EXPECT_GE(cell.height, height);
    EXPECT_LE(cell.width, 1.002 * width);
    EXPECT_LE(cell.height, 1.002 * height);
  };
  for (const double south : {-0.5, 43.0, 84.0}) {
    SyntheticGridOptions options;
    options.south = south;
    expectBound(syntheticGrid(options));
  }
  expectBound(projectedGrid());
}

}  // namespace
}  // namespace deltaz
