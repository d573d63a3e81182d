#include "libdb/access/tile_posts.h"

#include <bit>
#include <cstdint>
#include <gtest/gtest.h>
#include <thread>
#include <vector>

#include "tests/stress/stress_grids.h"
#include "tests/support/every_simd_target.h"

namespace deltaz {
namespace {

bool sameBits(double a, double b) {
  return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b);
}
bool sameBits(const Vector3& a, const Vector3& b) {
  return sameBits(a.x, b.x) && sameBits(a.y, b.y) && sameBits(a.z, b.z);
}

void expectGeometry(const TilePosts& posts) {
  const TerrainTile& tile = posts.tile();
  const GridGeometry& geometry = posts.geometry();
  const PostRange columns{tile.first_column - 1, tile.first_column + tile.columns + 1};
  const PostRange rows{tile.first_row - 1, tile.first_row + tile.rows + 1};
  std::size_t different = 0;
  for (std::size_t k = 0; k < tile.heights.size(); ++k) {
    different += sameBits(posts.heights()[k], geometry.metres(tile.heights[k])) ? 0 : 1;
    if (!posts.valid().empty()) different += (posts.valid()[k] > 0) == (tile.valid[k] != 0) ? 0 : 1;
  }
  if (geometry.isGeodetic()) {
    const std::vector<RowConstants> of_rows = geometry.rowConstantsOf(tile.level, rows);
    ASSERT_EQ(posts.rows().size(), of_rows.size());
    for (std::size_t j = 0; j < of_rows.size(); ++j) {
      const RowConstants &a = posts.rows()[j].at, &b = of_rows[j];
      different +=
          sameBits(a.a, b.a) && sameBits(a.b, b.b) && sameBits(a.c, b.c) && sameBits(a.s, b.s) ? 0 : 1;
    }
    const std::vector<ColumnConstants> of_columns = geometry.columnConstantsOf(tile.level, columns);
    for (std::size_t i = 0; i < of_columns.size(); ++i)
      different += sameBits(posts.columns().cosine[i], of_columns[i].cosine) &&
                           sameBits(posts.columns().sine[i], of_columns[i].sine)
                       ? 0
                       : 1;
  } else {
    const std::vector<PostPlace> places = geometry.postPlaces(tile.level, columns, rows);
    ASSERT_EQ(posts.positions().count(), places.size());
    for (std::size_t k = 0; k < places.size(); ++k) {
      different += sameBits(posts.ups().at(k), places[k].up) ? 0 : 1;
      different += sameBits(posts.positions().at(k), places[k].at(geometry.metres(tile.heights[k]))) ? 0 : 1;
    }
  }
  EXPECT_EQ(different, 0U);
}

TEST(TilePosts, are_what_the_geometry_says_on_every_instruction_set) {
  for (const NamedGrid& named : extremeGrids()) {
    SCOPED_TRACE(named.name);
    const GridGeometry geometry(named.grid.header, named.grid.patches);
    const TerrainTile tile = wholeTile(named.grid);
    onEverySimdTarget([&] {
      TilePosts posts;
      posts.prepare(tile, geometry);
      expectGeometry(posts);
    });
  }
}

TEST(TilePosts, of_a_projected_grid_are_the_same_across_patches_and_at_coarse_levels) {
  const RawGrid grid = projectedGrid(300, 150, 25);
  const GridGeometry geometry(grid.header, grid.patches);
  TerrainTile tile = wholeTile(grid);
  onEverySimdTarget([&] {
    TilePosts posts;
    for (const int level : {0, 1, 3}) {
      tile.level = level;
      posts.prepare(tile, geometry);
      expectGeometry(posts);
    }
  });
}

TEST(TilePosts, may_be_made_ready_for_one_tile_after_another) {
  const RawGrid geodetic = syntheticGrid({}), projected = projectedGrid(40, 30, 25);
  const GridGeometry of_geodetic(geodetic.header), of_projected(projected.header, projected.patches);
  const TerrainTile large = wholeTile(geodetic), small = wholeTile(projected);
  TilePosts posts;
  posts.prepare(large, of_geodetic);
  expectGeometry(posts);
  posts.prepare(small, of_projected);
  expectGeometry(posts);
  posts.prepare(large, of_geodetic);
  expectGeometry(posts);
}

TEST(TilePosts, list_validity_only_where_something_is_void) {
  const RawGrid grid = syntheticGrid({});
  const GridGeometry geometry(grid.header);
  TerrainTile tile = wholeTile(grid);
  tile.valid.assign(tile.valid.size(), 1);
  TilePosts posts;
  posts.prepare(tile, geometry);
  EXPECT_TRUE(posts.valid().empty());
  tile.valid.back() = 0;
  posts.prepare(tile, geometry);
  EXPECT_EQ(posts.valid().size(), tile.valid.size() + kVectorPadding);
  expectGeometry(posts);
}

TEST(PostAxes, steps_lead_from_each_row_and_column_to_the_next) {
  const RawGrid grid = syntheticGrid({});
  const GridGeometry geometry(grid.header);
  const std::int64_t first_row = geometry.header().y_axis.first,
                     first_column = geometry.header().x_axis.first;
  for (const int level : {0, 2}) {
    const std::int64_t step = std::int64_t{1} << level;
    // Across the borders of blocks, whatever their size below this.
    const PostRange rows{first_row / step, first_row / step + 300};
    const PostRange columns{first_column / step, first_column / step + 300};
    std::vector<RowTerms> of_rows;
    ColumnTerms of_columns;
    geometry.axes().rows(level, rows, of_rows);
    geometry.axes().columns(level, columns, of_columns);
    ASSERT_EQ(of_rows.size(), 300U);
    for (std::int64_t k = 0; k < 300; ++k) {
      const double south = geometry.latitude((rows.begin + k) * step);
      const double north = geometry.latitude((rows.begin + k + 1) * step);
      const RowStep of_row = rowStep(grid.header.ellipsoid, south, north);
      const auto at = static_cast<std::size_t>(k);
      EXPECT_TRUE(sameBits(of_rows[at].step.a, of_row.a) && sameBits(of_rows[at].step.b, of_row.b) &&
                  sameBits(of_rows[at].step.c, of_row.c) && sameBits(of_rows[at].step.s, of_row.s));
      const ColumnStep of_column = columnStep(geometry.longitude((columns.begin + k) * step),
                                              geometry.longitude((columns.begin + k + 1) * step));
      EXPECT_TRUE(sameBits(of_columns.step_cosine[at], of_column.cosine) &&
                  sameBits(of_columns.step_sine[at], of_column.sine));
    }
  }
}

TEST(PostAxes, are_the_same_for_threads_that_ask_at_once) {
  const RawGrid grid = syntheticGrid({});
  const GridGeometry geometry(grid.header);
  const PostRange rows{-700, 700};
  std::vector<std::vector<RowTerms>> found(4);
  std::vector<std::thread> threads;
  threads.reserve(found.size());
  for (std::vector<RowTerms>& terms : found)
    threads.emplace_back([&] { geometry.axes().rows(1, rows, terms); });
  for (std::thread& thread : threads) thread.join();
  std::size_t different = 0;
  for (const std::vector<RowTerms>& terms : found) {
    ASSERT_EQ(terms.size(), 1400U);
    for (std::size_t k = 0; k < terms.size(); ++k)
      different +=
          sameBits(terms[k].at.a, found[0][k].at.a) && sameBits(terms[k].step.c, found[0][k].step.c) ? 0 : 1;
  }
  EXPECT_EQ(different, 0U);
}

}  // namespace
}  // namespace deltaz
