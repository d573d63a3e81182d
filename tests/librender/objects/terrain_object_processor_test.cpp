#include "librender/objects/terrain_object_processor.h"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <string>

#include "librender/raster/pretiler.h"

namespace deltaz {
namespace {

struct Place {
  std::string name;
  double south, west;    // degrees
  std::int64_t spacing;  // arc-seconds
};

// Both poles, the antimeridian, the equator and somewhere else.
const Place kPlaces[] = {{"north pole", 89.5, 30, 30},
                         {"south pole", -90, -75, 30},
                         {"antimeridian", -17, 179.75, 15},
                         {"equator", -0.25, 9.5, 15},
                         {"Rainier", 46.5, -122, 3}};

GridHeader gridAt(const Place& place) {
  GridHeader grid;
  grid.quantum = {1, 1};
  grid.leaf_cells = 64;
  const std::int64_t per_degree = 3600 / place.spacing;
  for (GridAxis* axis : {&grid.x_axis, &grid.y_axis}) {
    axis->exact_spacing = Rational{place.spacing, 1};
    axis->spacing = static_cast<double>(place.spacing) / 3600;
    axis->count = 61;
  }
  grid.x_axis.first = static_cast<std::int64_t>((place.west + 180) * static_cast<double>(per_degree));
  grid.y_axis.first = static_cast<std::int64_t>((place.south + 90) * static_cast<double>(per_degree));
  return grid;
}

// All of a 61 x 61 grid as one tile, rough enough to have back faces.
TerrainTile tileOf(const GridHeader& grid) {
  TerrainTile tile;
  tile.first_column = grid.x_axis.first;
  tile.first_row = grid.y_axis.first;
  tile.columns = tile.rows = 61;
  tile.heights.resize(63 * 63);
  tile.valid.assign(63 * 63, 1);
  std::uint32_t state = 12345;
  for (std::int32_t& height : tile.heights) {
    state = state * 1664525u + 1013904223u;
    height = static_cast<std::int32_t>(state >> 20) - 200;
  }
  return tile;
}

TEST(TerrainObjectProcessor, vertices_unproject_to_geographiclib_positions) {
  for (const Place& place : kPlaces) {
    const GridHeader grid = gridAt(place);
    const GridGeometry geometry(grid);
    const TerrainTile tile = tileOf(grid);
    double worst = 0;
    EXPECT_TRUE(rc::check(place.name, [&] {
      Camera camera;
      camera.eye = {place.south + *rc::gen::inRange(0, 500) / 1000.0,
                    place.west + *rc::gen::inRange(-500, 1000) / 1000.0, *rc::gen::inRange(10, 300000) * 1.0};
      camera.heading = *rc::gen::inRange(0, 360);
      camera.pitch = *rc::gen::inRange(-89, 20);
      camera.roll = *rc::gen::inRange(-45, 45);
      camera.field_of_view = *rc::gen::inRange(1, 120);
      const ViewTransform view = makeViewTransform(camera, grid.ellipsoid);
      const std::vector<Vector3> position = terrainPositions(tile, geometry, view);
      for (int j = 0; j < tile.rows; ++j) {
        for (int i = 0; i < tile.columns; ++i) {
          const Vector3& p = position[static_cast<std::size_t>(j * tile.columns + i)];
          if (p.x < 0.1) continue;
          const Vector3 truth = toEarthCentred(grid.ellipsoid, {geometry.latitude(tile.first_row + j),
                                                                geometry.longitude(tile.first_column + i),
                                                                geometry.metres(tile.height(i, j))});
          const double error = length(unproject(view, project(view, p)) - truth);
          const double bound = 1e-3 + std::ldexp(length(truth - view.eye), -23);
          RC_ASSERT(error <= bound);
          worst = std::max(worst, error);
        }
      }
    }));
    RecordProperty(place.name.substr(0, 5), std::to_string(worst));
    // Far below the contract: doubles all the way.
    EXPECT_LT(worst, 1e-6) << place.name;
  }
}

TEST(TerrainObjectProcessor, a_post_shared_by_two_nodes_is_the_same_point) {
  const GridHeader grid = gridAt(kPlaces[4]);
  const GridGeometry geometry(grid);
  const TerrainTile whole = tileOf(grid);
  TerrainTile east = whole;  // columns 30 .. 60
  east.first_column += 30;
  east.columns = 31;
  east.heights.clear();
  east.valid.assign(33 * 63, 1);
  for (int j = -1; j <= 61; ++j) {
    for (int i = 29; i <= 61; ++i) east.heights.push_back(whole.height(i, j));
  }
  Camera camera;
  camera.eye = {46, -121.9, 5000};
  const ViewTransform view = makeViewTransform(camera, grid.ellipsoid);
  const std::vector<Vector3> a = terrainPositions(whole, geometry, view),
                             b = terrainPositions(east, geometry, view);
  for (int j = 0; j < 61; ++j) {
    for (int i = 30; i < 61; ++i) {
      EXPECT_EQ(a[static_cast<std::size_t>(j * 61 + i)], b[static_cast<std::size_t>(j * 31 + i - 30)]);
    }
  }
}

TEST(TerrainObjectProcessor, faces_seen_from_above_are_front_faces) {
  for (const Place& place : kPlaces) {
    const GridHeader grid = gridAt(place);
    TerrainTile tile = tileOf(grid);
    std::fill(tile.heights.begin(), tile.heights.end(), 100);
    Camera camera;
    camera.eye = {place.south + 0.2, place.west + 0.1, 900000};
    camera.pitch = -90;
    const ViewTransform view = makeViewTransform(camera, grid.ellipsoid);
    const TerrainFaces faces = terrainFaces(tile, terrainPositions(tile, GridGeometry(grid), view));
    EXPECT_EQ(faces.in, 60u * 60u * 2u);
    // In a pole row the faces with two posts on the pole have no extent.
    const std::uint64_t none = place.south == 89.5 || place.south == -90 ? 60 : 0;
    EXPECT_EQ(faces.back_facing, none) << place.name;
    EXPECT_EQ(faces.in, faces.back_facing + faces.front.size());
  }
}

TEST(TerrainObjectProcessor, faces_seen_from_below_are_back_faces) {
  const GridHeader grid = gridAt(kPlaces[4]);
  TerrainTile tile = tileOf(grid);
  Camera camera;
  camera.eye = {46.5, -122, -900000};
  camera.pitch = 90;
  const ViewTransform view = makeViewTransform(camera, grid.ellipsoid);
  std::fill(tile.heights.begin(), tile.heights.end(), 100);
  const TerrainFaces faces = terrainFaces(tile, terrainPositions(tile, GridGeometry(grid), view));
  EXPECT_EQ(faces.back_facing, faces.in);
}

TEST(TerrainObjectProcessor, a_void_post_takes_its_six_faces_with_it) {
  const GridHeader grid = gridAt(kPlaces[4]);
  TerrainTile tile = tileOf(grid);
  tile.valid[tile.index(20, 30)] = 0;
  Camera camera;
  camera.eye = {46.5, -122, 90000};
  camera.pitch = -90;
  const ViewTransform view = makeViewTransform(camera, grid.ellipsoid);
  const TerrainFaces faces = terrainFaces(tile, terrainPositions(tile, GridGeometry(grid), view));
  EXPECT_EQ(faces.in, 60u * 60u * 2u - 6u);
  for (const TerrainFace& face : faces.front) {
    for (const std::uint32_t vertex : face.vertex) EXPECT_NE(vertex, 30u * 61u + 20u);
  }
}

TEST(TerrainObjectProcessor, light_follows_the_slope) {
  const GridHeader grid = gridAt(kPlaces[4]);
  TerrainTile tile = tileOf(grid);
  // A ramp rising to the east; the sun in the west lights it, the sun in the east does not.
  for (int j = -1; j <= 61; ++j) {
    for (int i = -1; i <= 61; ++i) tile.heights[tile.index(i, j)] = 1000 + 60 * i;
  }
  AreaHeader area;
  area.west = -122;
  area.east = -121.9;
  area.south = 46.5;
  area.north = 46.6;
  area.grids.push_back(grid);
  const LinearColor lit =
      terrainShading(tile, GridGeometry(grid), makeLight(area, {270, 30})).color[30 * 61 + 30];
  const LinearColor dark =
      terrainShading(tile, GridGeometry(grid), makeLight(area, {90, 30})).color[30 * 61 + 30];
  const Light light;
  EXPECT_NEAR(dark.green / lit.green,
              light.ambient / (light.ambient + light.diffuse * std::cos((60 - 43.3) * std::acos(-1) / 180)),
              0.02);
}

}  // namespace
}  // namespace deltaz
