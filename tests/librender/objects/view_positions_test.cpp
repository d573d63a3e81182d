// The vectors against the transform's definition, post by post, on every instruction set of this processor.
#include "librender/objects/view_positions.h"

#include <bit>
#include <cstdint>
#include <gtest/gtest.h>

#include "tests/stress/stress_grids.h"
#include "tests/support/every_simd_target.h"

namespace deltaz {
namespace {

ViewTransform viewFrom(const GeodeticPoint& eye, const GridGeometry& geometry) {
  Camera camera;
  camera.eye = eye;
  camera.heading = 30;
  camera.pitch = -25;
  camera.roll = 5;
  return makeViewTransform(camera, geometry.header().ellipsoid);
}

// Each view coordinate of post (column, row, h) is (a + b h) k + (c + s h) m3 - t; on a projected grid the
// post's place goes through the view.
Vector3 definition(const TerrainTile& tile, const GridGeometry& geometry, const ViewTransform& view, int i,
                   int j) {
  const double height = geometry.metres(tile.height(i, j));
  const std::int64_t step = std::int64_t{1} << tile.level;
  const std::int64_t column = (tile.first_column + i) * step, row = (tile.first_row + j) * step;
  if (!geometry.isGeodetic()) return view.toView(geometry.placeAt(column, row).at(height));
  const RowConstants of_row = rowConstants(geometry.header().ellipsoid, geometry.latitude(row));
  const ColumnConstants of_column = columnConstants(geometry.longitude(column));
  const double distance = of_row.a + of_row.b * height, z = of_row.c + of_row.s * height;
  const auto along = [&](const Vector3& m) {
    const double k = m.x * of_column.cosine + m.y * of_column.sine;
    return distance * k + (z * m.z - dot(m, view.eye));
  };
  return {along(view.forward), along(view.right * view.pixels), along(view.down * view.pixels)};
}

bool sameBits(const Vector3& a, const Vector3& b) {
  const auto bits = [](double value) { return std::bit_cast<std::uint64_t>(value); };
  return bits(a.x) == bits(b.x) && bits(a.y) == bits(b.y) && bits(a.z) == bits(b.z);
}

void expectDefinition(const TerrainTile& tile, const GridGeometry& geometry, const ViewTransform& view) {
  ViewPositions positions;
  onEverySimdTarget([&] {
    terrainViewPositions(tile, geometry, view, positions);
    ASSERT_EQ(positions.count(),
              static_cast<std::size_t>(tile.columns) * static_cast<std::size_t>(tile.rows));
    std::size_t post = 0, different = 0;
    for (int j = 0; j < tile.rows; ++j) {
      for (int i = 0; i < tile.columns; ++i, ++post)
        different += sameBits(positions.at(post), definition(tile, geometry, view, i, j)) ? 0 : 1;
    }
    EXPECT_EQ(different, 0U) << tile.columns << " x " << tile.rows;
    for (const std::vector<double>* list : {&positions.u, &positions.v, &positions.w}) {
      for (std::size_t k = 0; k < ViewPositions::kPadding; ++k) EXPECT_EQ((*list)[post + k], 0);
    }
  });
}

TEST(ViewPositions, every_instruction_set_gives_the_definitions_bits) {
  for (const NamedGrid& named : extremeGrids()) {
    SCOPED_TRACE(named.name);
    const GridGeometry geometry(named.grid.header, named.grid.patches);
    TerrainTile tile = wholeTile(named.grid);
    const std::int64_t column = named.grid.header.x_axis.first, row = named.grid.header.y_axis.first;
    GeodeticPoint eye = geometry.geodeticAt(column, row);
    for (const double height : {2.0, 30000.0}) {
      eye.height = height;
      expectDefinition(tile, geometry, viewFrom(eye, geometry));
    }
  }
}

TEST(ViewPositions, tiles_of_any_width_keep_the_definitions_bits) {
  for (int columns = 1; columns <= 19; ++columns) {
    for (const int rows : {1, 2, 3, 8}) {
      SyntheticGridOptions options;
      options.columns = columns;
      options.rows = rows;
      const RawGrid grid = syntheticGrid(options);
      const GridGeometry geometry(grid.header);
      TerrainTile tile = wholeTile(grid);
      expectDefinition(tile, geometry, viewFrom({43.1, -79.6, 2000}, geometry));
    }
  }
}

TEST(ViewPositions, projected_grids_keep_the_definitions_bits_across_patches) {
  for (const int level : {0, 2}) {
    const RawGrid grid = projectedGrid(300, 150, 25);
    const GridGeometry geometry(grid.header, grid.patches);
    TerrainTile tile = wholeTile(grid);
    if (level > 0) {
      tile.level = level;
      tile.first_column = geometry.columnsAt(level).begin;
      tile.first_row = geometry.rowsAt(level).begin;
      tile.columns = static_cast<int>(geometry.columnsAt(level).size());
      tile.rows = static_cast<int>(geometry.rowsAt(level).size());
    }
    expectDefinition(tile, geometry, viewFrom({46.01, 7.01, 3000}, geometry));
  }
}

TEST(ViewPositions, a_list_used_before_is_filled_in_place) {
  const RawGrid grid = syntheticGrid({});
  const GridGeometry geometry(grid.header);
  const TerrainTile tile = wholeTile(grid);
  ViewPositions positions;
  terrainViewPositions(tile, geometry, viewFrom({43.1, -79.6, 2000}, geometry), positions);
  const double* const before = positions.u.data();
  TerrainTile smaller = tile;
  smaller.rows -= 1;
  terrainViewPositions(smaller, geometry, viewFrom({43.1, -79.6, 2000}, geometry), positions);
  EXPECT_EQ(positions.u.data(), before);
  EXPECT_EQ(positions.count(),
            static_cast<std::size_t>(smaller.columns) * static_cast<std::size_t>(smaller.rows));
}

TEST(ViewPositions, a_tile_without_posts_has_none) {
  const RawGrid grid = syntheticGrid({});
  TerrainTile tile;
  tile.heights.assign(4, 0);
  tile.valid.assign(4, 0);
  const GridGeometry geometry(grid.header);
  ViewPositions positions;
  terrainViewPositions(tile, geometry, viewFrom({43, -80, 100}, geometry), positions);
  EXPECT_EQ(positions.count(), 0U);
}

}  // namespace
}  // namespace deltaz
