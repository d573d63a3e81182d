// The four transforms against positions in extended precision, and their proved bounds.
#include "librender/objects/transform_posts.h"

#include <bit>
#include <cmath>
#include <cstdint>
#include <gtest/gtest.h>
#include <rapidcheck.h>

#include "librender/objects/terrain_object_processor.h"
#include "librender/objects/transform_error_bound.h"
#include "librender/scene/view_volume.h"
#include "tests/stress/scalar_transforms.h"
#include "tests/stress/stress_grids.h"
#include "tests/stress/true_positions.h"
#include "tests/support/every_simd_target.h"

namespace deltaz {
namespace {

Camera cameraAt(double latitude, double longitude, double height) {
  Camera camera;
  camera.eye = {latitude, longitude, height};
  camera.heading = 30;
  camera.pitch = -25;
  camera.roll = 5;
  return camera;
}

// Positions of one post by the definition of each view coordinate, or a failed expectation.
std::vector<Vector3> positionsOf(TransformKind kind, const TerrainTile& tile, const GridGeometry& geometry,
                                 const ViewTransform& view) {
  Result<std::vector<Vector3>> positions = transformPosts(kind, tile, geometry, view);
  EXPECT_TRUE(positions.ok()) << transformName(kind);
  return positions.ok() ? std::move(positions).value() : std::vector<Vector3>{};
}

TEST(TransformPosts, no_transform_is_farther_off_than_its_bound) {
  for (const TransformKind kind : kTransformKinds) {
    double closest = 0;
    EXPECT_TRUE(rc::check(std::string(transformName(kind)), [&] {
      SyntheticGridOptions options;
      options.seed = *rc::gen::inRange<std::uint32_t>(1, 1000);
      options.south = *rc::gen::inRange(-900, 895) / 10.0;
      options.west = *rc::gen::inRange(-1800, 1800) / 10.0;
      options.spacing_latitude = {*rc::gen::element<std::int64_t>(1, 3, 30), 1};
      options.spacing_longitude = {*rc::gen::element<std::int64_t>(1, 3, 30), 1};
      options.columns = *rc::gen::inRange(2, 60);
      options.rows = *rc::gen::inRange(2, 60);
      options.highest = *rc::gen::inRange(-40, 9000);
      options.quantum = *rc::gen::element(Rational{1, 1}, Rational{1200, 3937}, Rational{1, 100});
      const RawGrid grid = syntheticGrid(options);
      const GridGeometry geometry(grid.header);
      const TerrainTile tile = wholeTile(grid);
      Camera camera =
          cameraAt(options.south, options.west, std::pow(10.0, *rc::gen::inRange(-200, 701) / 100.0));
      camera.heading = *rc::gen::inRange(0, 360);
      camera.pitch = *rc::gen::inRange(-89, 90);
      camera.field_of_view = *rc::gen::inRange(1, 170);
      const ViewTransform view = makeViewTransform(camera, grid.header.ellipsoid);
      const Result<std::vector<Vector3>> positions = transformPosts(kind, tile, geometry, view);
      RC_ASSERT(positions.ok());
      const double observed = largestError(tile, view, positions.value(), truePositions(tile, geometry));
      const double bound = transformErrorBound(kind, tile, geometry, view);
      RC_ASSERT(observed <= bound);
      closest = std::max(closest, observed / bound);
    }));
    std::printf("%s: at most %.3f of its bound\n", std::string(transformName(kind)).c_str(), closest);
    EXPECT_GT(closest, 0.02) << "a bound so far off says nothing";
  }
}

void expectDefinition(const TerrainTile& tile, const GridGeometry& geometry, const ViewTransform& view) {
  for (const TransformKind kind : kTransformKinds) {
    std::vector<Vector3> expected;
    ScalarTransform(kind, tile, geometry).apply(view, expected);
    onEverySimdTarget([&] {
      const Result<TileTransform> transform = TileTransform::make(kind, tile, geometry);
      ASSERT_TRUE(transform.ok());
      ViewPositions positions;
      transform.value().apply(view, positions);
      ASSERT_EQ(positions.count(), expected.size());
      std::size_t different = 0;
      const auto bits = [](double value) { return std::bit_cast<std::uint64_t>(value); };
      for (std::size_t k = 0; k < expected.size(); ++k)
        different += bits(positions.u[k]) == bits(expected[k].x) &&
                             bits(positions.v[k]) == bits(expected[k].y) &&
                             bits(positions.w[k]) == bits(expected[k].z)
                         ? 0
                         : 1;
      EXPECT_EQ(different, 0U) << transformName(kind) << " " << tile.columns << " x " << tile.rows;
      for (std::size_t k = 0; k < ViewPositions::kPadding; ++k)
        EXPECT_EQ(positions.u[expected.size() + k], 0);
    });
  }
}

TEST(TransformPosts, every_instruction_set_gives_the_definitions_bits) {
  for (const NamedGrid& named : extremeGrids()) {
    SCOPED_TRACE(named.name);
    const GridGeometry geometry(named.grid.header, named.grid.patches);
    const GeodeticPoint corner =
        geometry.geodeticAt(named.grid.header.x_axis.first, named.grid.header.y_axis.first);
    expectDefinition(
        wholeTile(named.grid), geometry,
        makeViewTransform(cameraAt(corner.latitude, corner.longitude, 900), named.grid.header.ellipsoid));
  }
  const RawGrid projected = projectedGrid(100, 70, 30);
  expectDefinition(wholeTile(projected), GridGeometry(projected.header, projected.patches),
                   makeViewTransform(cameraAt(46.01, 7.01, 3000), projected.header.ellipsoid));
}

TEST(TransformPosts, tiles_of_any_size_keep_the_definitions_bits) {
  for (int columns = 1; columns <= 19; ++columns) {
    for (int rows = 1; rows <= 19; rows += columns == 5 ? 1 : 6) {
      SyntheticGridOptions options;
      options.columns = columns;
      options.rows = rows;
      const RawGrid grid = syntheticGrid(options);
      expectDefinition(wholeTile(grid), GridGeometry(grid.header),
                       makeViewTransform(cameraAt(43.1, -79.6, 2000), grid.header.ellipsoid));
    }
  }
}

TEST(TransformPosts, what_is_kept_is_as_small_as_the_header_says) {
  const RawGrid grid = syntheticGrid({});
  const GridGeometry geometry(grid.header);
  const TerrainTile tile = wholeTile(grid);
  const auto bytes = [&](TransformKind kind) {
    const std::size_t stored = TileTransform::make(kind, tile, geometry).value().storedBytes();
    return static_cast<double>(stored) / (121.0 * 121.0);
  };
  EXPECT_EQ(bytes(TransformKind::kExact), 0);
  EXPECT_NEAR(bytes(TransformKind::kDelta), 4, 0.5);
  EXPECT_NEAR(bytes(TransformKind::kMatrix), 4, 0.1);
  EXPECT_NEAR(bytes(TransformKind::kLocal), 12, 0.1);
}

TEST(TransformPosts, exact_is_the_object_processor) {
  const RawGrid grid = syntheticGrid({});
  const GridGeometry geometry(grid.header);
  const TerrainTile tile = wholeTile(grid);
  const ViewTransform view = makeViewTransform(cameraAt(43.2, -79.5, 3000), grid.header.ellipsoid);
  EXPECT_EQ(positionsOf(TransformKind::kExact, tile, geometry, view), terrainPositions(tile, geometry, view));
}

// On a flat grid small enough for the Earth's curvature not to matter, all four are the same plane.
TEST(TransformPosts, all_agree_on_a_small_flat_tile) {
  SyntheticGridOptions options;
  options.columns = options.rows = 9;
  options.spacing_latitude = options.spacing_longitude = {1, 10};  // 3 m
  options.lowest = options.highest = 100;
  const RawGrid grid = syntheticGrid(options);
  const GridGeometry geometry(grid.header);
  const TerrainTile tile = wholeTile(grid);
  const ViewTransform view =
      makeViewTransform(cameraAt(options.south, options.west, 150), grid.header.ellipsoid);
  const std::vector<LongVector> truth = truePositions(tile, geometry);
  for (const TransformKind kind : kTransformKinds) {
    EXPECT_LT(largestError(tile, view, positionsOf(kind, tile, geometry, view), truth), 2e-4)
        << transformName(kind);
  }
}

// What the flat grid leaves out is the sag of a tangent plane, d^2 / (2 R), and nothing much else.
TEST(TransformPosts, the_flat_transforms_err_by_the_curvature_of_the_earth) {
  SyntheticGridOptions options;
  options.south = 0;
  options.columns = options.rows = 65;
  options.lowest = options.highest = 0;
  const RawGrid grid = syntheticGrid(options);
  const GridGeometry geometry(grid.header);
  const TerrainTile tile = wholeTile(grid);
  const ViewTransform view = makeViewTransform(cameraAt(0.25, -79.7, 20000), grid.header.ellipsoid);
  const std::vector<LongVector> truth = truePositions(tile, geometry);
  const double half = 32 * 30 / 3600.0 * std::acos(-1.0) / 180 * 6378137;
  const double sag = 2 * half * half / (2 * 6378137);
  for (const TransformKind kind : {TransformKind::kDelta, TransformKind::kMatrix}) {
    const double observed = largestError(tile, view, positionsOf(kind, tile, geometry, view), truth);
    EXPECT_NEAR(observed, sag, 0.02 * sag) << transformName(kind);
    EXPECT_LT(transformErrorBound(kind, tile, geometry, view), 1.2 * sag);
  }
  EXPECT_LT(largestError(tile, view, positionsOf(TransformKind::kLocal, tile, geometry, view), truth), 0.01);
}

TEST(TransformPosts, projected_grids_are_served_within_the_bound) {
  const RawGrid grid = projectedGrid(100, 70, 30);
  const GridGeometry geometry(grid.header, grid.patches);
  const TerrainTile tile = wholeTile(grid);
  for (const double height : {10.0, 3000.0, 1e6}) {
    const ViewTransform view = makeViewTransform(cameraAt(46.01, 7.01, height), grid.header.ellipsoid);
    const std::vector<LongVector> truth = truePositions(tile, geometry);
    for (const TransformKind kind : kTransformKinds) {
      const double observed = largestError(tile, view, positionsOf(kind, tile, geometry, view), truth);
      const double bound = transformErrorBound(kind, tile, geometry, view);
      EXPECT_LE(observed, bound) << transformName(kind) << " from " << height;
    }
  }
}

// What a crack between two nodes is: the post they share, twice.
TEST(TransformPosts, a_post_that_two_tiles_share_is_apart_by_no_more_than_both_bounds) {
  for (const bool geodetic : {true, false}) {
    const RawGrid grid = geodetic ? syntheticGrid({}) : projectedGrid(121, 121, 30);
    const GridGeometry geometry(grid.header, grid.patches);
    const TerrainTile whole = wholeTile(grid), west = columnsOf(whole, 0, 61),
                      east = columnsOf(whole, 60, 61);
    const GeodeticPoint corner = geometry.geodeticAt(whole.first_column, whole.first_row);
    for (const double height : {3000.0, 1e5}) {
      const ViewTransform view =
          makeViewTransform(cameraAt(corner.latitude, corner.longitude, height), grid.header.ellipsoid);
      for (const TransformKind kind : kTransformKinds) {
        const std::vector<Vector3> of_west = positionsOf(kind, west, geometry, view),
                                   of_east = positionsOf(kind, east, geometry, view);
        double widest = 0;
        for (std::size_t j = 0; j < 121; ++j) {
          const Vector3 d = of_west[j * 61 + 60] - of_east[j * 61];
          widest = std::max(widest, std::hypot(d.x, d.y / view.pixels, d.z / view.pixels));
        }
        EXPECT_LE(widest, transformErrorBound(kind, west, geometry, view) +
                              transformErrorBound(kind, east, geometry, view))
            << transformName(kind);
        if (kind == TransformKind::kExact) {
          EXPECT_EQ(widest, 0) << "exact leaves no cracks";
        } else {
          EXPECT_GT(widest, 0) << transformName(kind);
        }
      }
    }
  }
}

TEST(TransformPixelBound, holds_for_every_point_in_the_picture) {
  for (const TransformKind kind : kTransformKinds) {
    double closest = 0;
    const auto holds = [&] {
      SyntheticGridOptions options;
      options.seed = *rc::gen::inRange<std::uint32_t>(1, 1000);
      options.spacing_latitude = options.spacing_longitude = {*rc::gen::element<std::int64_t>(1, 3, 30), 1};
      options.columns = options.rows = *rc::gen::inRange(3, 40);
      const RawGrid grid = syntheticGrid(options);
      const GridGeometry geometry(grid.header);
      const TerrainTile tile = wholeTile(grid);
      Camera camera =
          cameraAt(options.south, options.west, std::pow(10.0, *rc::gen::inRange(0, 600) / 100.0));
      camera.heading = *rc::gen::inRange(0, 90);
      camera.pitch = *rc::gen::inRange(-89, 10);
      camera.field_of_view = *rc::gen::inRange(10, 120);
      const ViewTransform view = makeViewTransform(camera, grid.header.ellipsoid);
      const std::vector<Vector3> drawn = transformPosts(kind, tile, geometry, view).value();
      const std::vector<LongVector> truth = truePositions(tile, geometry);
      const double bound =
          transformPixelBound(transformErrorBound(kind, tile, geometry, view), tile, drawn, view);
      // Points all over the faces: the corners and the middles of the cells' diagonals.
      for (int j = 0; j + 1 < tile.rows; ++j) {
        for (int i = 0; i + 1 < tile.columns; ++i) {
          const auto a = static_cast<std::size_t>(j * tile.columns + i);
          const std::size_t b = a + static_cast<std::size_t>(tile.columns) + 1;
          for (const double t : {0.0, 0.5}) {
            const Vector3 q = drawn[a] + (drawn[b] - drawn[a]) * t;
            if (q.x < kHither || std::abs(q.y / q.x) > camera.width / 2.0 ||
                std::abs(q.z / q.x) > camera.height / 2.0)
              continue;
            const LongVector of_a = trueView(view, truth[a]), of_b = trueView(view, truth[b]);
            const auto between = [&](long double from, long double to) {
              return static_cast<double>(from + (to - from) * static_cast<long double>(t));
            };
            const double u = between(of_a.x, of_b.x);
            const double shift = std::hypot(q.y / q.x - between(of_a.y, of_b.y) / u * view.pixels,
                                            q.z / q.x - between(of_a.z, of_b.z) / u * view.pixels);
            // What the doubles of a picture's coordinates leave.
            RC_ASSERT(shift <= bound + 1e-9);
            if (std::isfinite(bound)) closest = std::max(closest, shift / bound);
          }
        }
      }
    };
    // With one case at a time three runs of a hundred come nowhere near the bound.
    EXPECT_TRUE(rc::check(std::string(transformName(kind)), [&] {
      for (int n = 0; n < 8; ++n) holds();
    }));
    std::printf("%s: at most %.3f of its bound in pixels\n", std::string(transformName(kind)).c_str(),
                closest);
    EXPECT_GT(closest, 0.01) << "a bound so far off says nothing";
  }
}

TEST(TransformPixelBound, has_no_say_on_what_may_touch_the_eye) {
  const RawGrid grid = syntheticGrid({});
  const GridGeometry geometry(grid.header);
  const TerrainTile tile = wholeTile(grid);
  Camera camera = cameraAt(43.5, -79.5, 2500);
  const ViewTransform view = makeViewTransform(camera, grid.header.ellipsoid);
  const std::vector<Vector3> drawn = transformPosts(TransformKind::kExact, tile, geometry, view).value();
  EXPECT_EQ(transformPixelBound(0, tile, drawn, view), 0);
  EXPECT_TRUE(std::isinf(transformPixelBound(1e6, tile, drawn, view)));
}

TEST(TransformPosts, a_projected_grid_without_patches_is_refused) {
  const RawGrid grid = projectedGrid(20, 20, 30);
  const GridGeometry geometry(grid.header);
  const TerrainTile tile = wholeTile(grid);
  for (const TransformKind kind : kTransformKinds)
    EXPECT_FALSE(TileTransform::make(kind, tile, geometry).ok()) << transformName(kind);
}

TEST(TransformPosts, a_tile_without_posts_has_no_positions) {
  const RawGrid grid = syntheticGrid({});
  const GridGeometry geometry(grid.header);
  TerrainTile tile;
  tile.heights.assign(4, 0);
  tile.valid.assign(4, 0);
  const ViewTransform view = makeViewTransform(cameraAt(43, -80, 100), grid.header.ellipsoid);
  for (const TransformKind kind : kTransformKinds) {
    EXPECT_TRUE(positionsOf(kind, tile, geometry, view).empty());
    EXPECT_EQ(transformErrorBound(kind, tile, geometry, view), 0);
  }
}

TEST(TransformPosts, coarser_levels_are_served_too) {
  const RawGrid grid = syntheticGrid({});
  const GridGeometry geometry(grid.header);
  TerrainTile tile = wholeTile(grid);
  tile.level = 2;
  tile.first_column = tile.first_row = 0;
  const ViewTransform view = makeViewTransform(cameraAt(-89, -179, 4000), grid.header.ellipsoid);
  const std::vector<LongVector> truth = truePositions(tile, geometry);
  for (const TransformKind kind : kTransformKinds) {
    EXPECT_LE(largestError(tile, view, positionsOf(kind, tile, geometry, view), truth),
              transformErrorBound(kind, tile, geometry, view))
        << transformName(kind);
  }
}

}  // namespace
}  // namespace deltaz
