#include "librender/objects/terrain_shading.h"

#include <cmath>
#include <cstdint>
#include <gtest/gtest.h>
#include <numbers>

#include "libdb/access/synthetic_color.h"
#include "libdb/access/vertex_normals.h"
#include "librender/objects/terrain_vertex_lists.h"
#include "tests/stress/stress_grids.h"
#include "tests/support/every_simd_target.h"

namespace deltaz {
namespace {

const Light kLight{normalized({0.3, -0.5, 0.8})};

struct Shading {
  VectorLists normals;
  std::vector<double> intensity;
  PostColors colors;
};

Shading shadingOf(const TerrainTile& tile, const GridGeometry& geometry) {
  TilePosts posts;
  posts.prepare(tile, geometry);
  Shading shading;
  vertexNormals(posts, shading.normals);
  terrainIntensity(shading.normals, kLight, shading.intensity);
  terrainColors(posts, shading.normals, shading.intensity, shading.colors);
  return shading;
}

// Colour by rule at each post from the definition of a surface point.
void expectDefinition(const TerrainTile& tile, const GridGeometry& geometry) {
  const Shading shading = shadingOf(tile, geometry);
  const std::int64_t step = std::int64_t{1} << tile.level;
  std::size_t k = 0;
  for (int j = 0; j < tile.rows; ++j) {
    for (int i = 0; i < tile.columns; ++i, ++k) {
      const std::int64_t column = (tile.first_column + i) * step, row = (tile.first_row + j) * step;
      const Vector3 up = geometry.placeAt(column, row).up, normal = shading.normals.at(k);
      ASSERT_EQ(shading.intensity[k], kLight.intensity(normal));
      const double latitude = geometry.isGeodetic()
                                  ? geometry.latitude(row)
                                  : std::atan2(up.z, std::hypot(up.x, up.y)) * (180 / std::numbers::pi);
      const LinearColor color =
          naturalColor(surfacePoint(geometry.metres(tile.height(i, j)), normal, up, latitude)) *
          shading.intensity[k];
      ASSERT_NEAR(shading.colors.red[k], color.red, 1e-9) << i << " " << j;
      ASSERT_NEAR(shading.colors.green[k], color.green, 1e-9) << i << " " << j;
      ASSERT_NEAR(shading.colors.blue[k], color.blue, 1e-9) << i << " " << j;
    }
  }
}

void expectSameEverywhere(const TerrainTile& tile, const GridGeometry& geometry) {
  limitSimdTarget(SimdTarget::kPortable);
  const Shading expected = shadingOf(tile, geometry);
  onEverySimdTarget([&] {
    const Shading shading = shadingOf(tile, geometry);
    EXPECT_EQ(shading.intensity, expected.intensity);
    EXPECT_EQ(shading.colors.red, expected.colors.red);
    EXPECT_EQ(shading.colors.green, expected.colors.green);
    EXPECT_EQ(shading.colors.blue, expected.colors.blue);
  });
}

TEST(TerrainShading, is_what_the_definition_says_at_every_post) {
  for (const NamedGrid& named : extremeGrids()) {
    SCOPED_TRACE(named.name);
    const GridGeometry geometry(named.grid.header, named.grid.patches);
    expectDefinition(wholeTile(named.grid), geometry);
    expectSameEverywhere(wholeTile(named.grid), geometry);
  }
  const RawGrid grid = projectedGrid(90, 40, 25);
  const GridGeometry geometry(grid.header, grid.patches);
  expectDefinition(wholeTile(grid), geometry);
  expectSameEverywhere(wholeTile(grid), geometry);
}

TEST(TerrainVertexLists, are_positions_light_and_colours_of_the_same_posts) {
  const RawGrid grid = syntheticGrid({});
  const GridGeometry geometry(grid.header);
  const TerrainTile tile = wholeTile(grid);
  Camera camera;
  camera.eye = {43.2, -79.5, 3000};
  const ViewTransform view = makeViewTransform(camera, grid.header.ellipsoid);
  TerrainVertexLists lists;
  terrainVertexLists(tile, geometry, view, kLight, lists);
  ViewPositions positions;
  terrainViewPositions(tile, geometry, view, positions);
  const Shading shading = shadingOf(tile, geometry);
  EXPECT_EQ(lists.position.u, positions.u);
  EXPECT_EQ(lists.position.v, positions.v);
  EXPECT_EQ(lists.position.w, positions.w);
  EXPECT_EQ(lists.intensity, shading.intensity);
  EXPECT_EQ(lists.color.red, shading.colors.red);
  const double* const before = lists.position.u.data();
  TerrainVertexLists uncolored;
  terrainVertexLists(tile, geometry, view, kLight, uncolored, {PostColoring::kNone});
  EXPECT_EQ(uncolored.intensity, shading.intensity);
  EXPECT_TRUE(uncolored.color.red.empty());
  terrainVertexLists(tile, geometry, view, kLight, lists);
  EXPECT_EQ(lists.position.u.data(), before);
}

TEST(TerrainVertexLists, of_a_tile_without_posts_are_empty) {
  const RawGrid grid = syntheticGrid({});
  TerrainTile tile;
  tile.heights.assign(4, 0);
  tile.valid.assign(4, 0);
  TerrainVertexLists lists;
  terrainVertexLists(tile, GridGeometry(grid.header), {}, kLight, lists);
  EXPECT_EQ(lists.position.count(), 0U);
  EXPECT_EQ(lists.intensity.size(), kVectorPadding);
}

}  // namespace
}  // namespace deltaz
