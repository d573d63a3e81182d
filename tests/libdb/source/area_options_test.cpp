// Cutting, filling and resampling.
#include <cmath>
#include <gtest/gtest.h>

#include "libdb/access/grid_geometry.h"
#include "tests/libdb/source/test_rasters.h"

namespace deltaz {
namespace {

// Posts at whole seconds from (0, 0) on, a plane that rises 2 m a post eastwards and 3 m northwards.
TestRaster plane(int columns, int rows) {
  TestRaster raster;
  raster.columns = columns;
  raster.rows = rows;
  raster.transform = {-0.5 / 3600, 1.0 / 3600, 0, (rows - 0.5) / 3600, 0, -1.0 / 3600};
  for (int row = rows - 1; row >= 0; --row) {
    for (int column = 0; column < columns; ++column) raster.values.push_back(2 * column + 3 * row);
  }
  return raster;
}

TEST(Bounds, posts_inside_are_kept_and_one_beyond_each_side) {
  const TemporaryDirectory folder;
  const std::string path = makeRaster(folder, plane(20, 20));
  const RawGrid grid =
      readOne(path, {.bounds = SourceBounds{4.5 / 3600, 6.0 / 3600, 9.2 / 3600, 12.0 / 3600}});
  EXPECT_EQ(grid.header.x_axis.first - 180 * 3600, 4);
  EXPECT_EQ(grid.header.x_axis.count, 7);  // 4 .. 10
  EXPECT_EQ(grid.header.y_axis.first - 90 * 3600, 6);
  EXPECT_EQ(grid.header.y_axis.count, 7);  // bounds on a post do not go beyond it
  EXPECT_EQ(grid.height(0, 0), 2 * 4 + 3 * 6);
  EXPECT_EQ(readElevationSource(path, {.bounds = SourceBounds{1, 1, 2, 2}}).error().kind, ErrorKind::kUsage);
}

TEST(Bounds, across_the_antimeridian) {
  const TemporaryDirectory folder;
  TestRaster raster = plane(20, 20);
  raster.transform[0] = 180 - 10.5 / 3600;
  const RawGrid grid = readOne(makeRaster(folder, raster),
                               {.bounds = SourceBounds{180 - 3.0 / 3600, 0, -180 + 4.0 / 3600, 1}});
  EXPECT_EQ(grid.header.x_axis.count, 8);
  EXPECT_EQ(grid.height(0, 0), 2 * 7);
}

// Posts at whole degrees all round the Earth, `columns` of them from `west` on; a height for each meridian.
TestRaster globe(double west, int columns) {
  TestRaster raster;
  raster.columns = columns;
  raster.rows = 21;
  raster.transform = {west - 0.5, 1, 0, 10.5, 0, -1};
  for (int row = 20; row >= 0; --row) {
    for (int column = 0; column < columns; ++column)
      raster.values.push_back(std::fmod(west + column + 720, 360) + 10 * row);
  }
  return raster;
}

TEST(Bounds, of_a_grid_that_goes_round_the_earth_run_on_over_its_seam) {
  const TemporaryDirectory folder;
  struct Case {
    double west;
    int columns;
    double from, to;
  };
  for (const Case& c : {Case{-180, 361, 170, -170}, Case{-180, 360, 170, -170}, Case{0, 360, -10, 10},
                        Case{0, 361, -10, 10}, Case{-180, 360, 100, 50}}) {
    const std::string path = makeRaster(folder, globe(c.west, c.columns));
    const RawGrid grid = readOne(path, {.bounds = SourceBounds{c.from, -5, c.to, 5}});
    const double width = std::fmod(c.to - c.from + 360, 360);
    EXPECT_EQ(grid.header.x_axis.count, static_cast<std::int64_t>(width) + 1) << c.west << ", " << c.columns;
    EXPECT_EQ(postCoordinate(grid.header.x_axis, kLongitudeOrigin, grid.header.x_axis.first), c.from);
    for (std::int64_t row = 0; row < grid.header.y_axis.count; ++row) {
      for (std::int64_t column = 0; column < grid.header.x_axis.count; ++column)
        ASSERT_EQ(grid.height(column, row), std::fmod(c.from + static_cast<double>(column) + 720, 360) +
                                                10.0 * (static_cast<double>(row) + 5));
    }
  }
}

TEST(Bounds, a_shared_meridian_keeps_the_height_that_either_side_has) {
  const TemporaryDirectory folder;
  TestRaster raster = globe(-180, 361);
  for (std::size_t row = 0; row < 21; ++row) raster.values[row * 361 + (row % 2 == 0 ? 0 : 360)] = -32768;
  raster.change = [](GDALDataset& dataset) { dataset.GetRasterBand(1)->SetNoDataValue(-32768); };
  const RawGrid grid = readOne(makeRaster(folder, raster), {.bounds = SourceBounds{170, -10, -170, 10}});
  ASSERT_EQ(grid.header.x_axis.count, 21);
  for (std::int64_t row = 0; row < 21; ++row) {
    EXPECT_TRUE(grid.isValid(10, row)) << row;
    EXPECT_EQ(grid.height(10, row), 180 + 10 * row);
  }
}

// Nothing from 100 degrees east to 100 west: what bounds across the antimeridian leave is in two parts.
TEST(Bounds, both_sides_of_ground_that_is_not_there_are_kept) {
  const TemporaryDirectory folder;
  TestRaster raster = globe(-100, 201);
  std::vector<std::string> warnings;
  const SourceArea area = readAll({makeRaster(folder, raster)}, {.bounds = SourceBounds{90, -5, -95, 5}});
  ASSERT_EQ(area.grids.size(), 2u);
  EXPECT_EQ(area.warnings.size(), 1u);
  EXPECT_EQ(area.grids[0].header.x_axis.count, 6);
  EXPECT_EQ(area.grids[0].height(0, 0), 260 + 50);
  EXPECT_EQ(area.grids[1].header.x_axis.count, 11);
  EXPECT_EQ(area.grids[1].height(0, 0), 90 + 50);
}

TEST(Bounds, of_a_projected_grid) {
  const TemporaryDirectory folder;
  TestRaster raster = plane(400, 400);
  raster.crs = "EPSG:32631";
  raster.transform = {500000 - 15, 30, 0, 5000000, 0, -30};
  const std::string path = makeRaster(folder, raster);
  const RawGrid whole = readOne(path);
  const GridGeometry geometry(whole.header, whole.patches);
  const GeodeticPoint low =
      geometry.geodeticAt(whole.header.x_axis.first + 100, whole.header.y_axis.first + 100);
  const GeodeticPoint high =
      geometry.geodeticAt(whole.header.x_axis.first + 200, whole.header.y_axis.first + 150);
  const RawGrid cut =
      readOne(path, {.bounds = SourceBounds{low.longitude, low.latitude, high.longitude, high.latitude}});
  EXPECT_LE(cut.header.x_axis.first, whole.header.x_axis.first + 100);
  EXPECT_GE(cut.header.x_axis.first, whole.header.x_axis.first + 90);
  EXPECT_NEAR(static_cast<double>(cut.header.x_axis.count), 101, 12);
  EXPECT_NEAR(static_cast<double>(cut.header.y_axis.count), 51, 12);
  EXPECT_EQ(cut.height(0, 0), whole.height(cut.header.x_axis.first - whole.header.x_axis.first,
                                           cut.header.y_axis.first - whole.header.y_axis.first));
}

TEST(VoidFilling, voids_take_heights_between_their_neighbours_and_are_counted) {
  const TemporaryDirectory folder;
  TestRaster raster = plane(9, 9);
  raster.values[40] = raster.values[41] = -32768;
  raster.change = [](GDALDataset& dataset) { dataset.GetRasterBand(1)->SetNoDataValue(-32768); };
  const std::string path = makeRaster(folder, raster);
  const SourceArea area = readAll({path}, {.voids = VoidPolicy::kFill});
  EXPECT_EQ(area.filled_posts, 2u);
  const RawGrid& grid = area.grids[0];
  EXPECT_TRUE(grid.valid.empty());
  EXPECT_NEAR(grid.height(4, 4), 2 * 4 + 3 * 4, 4);
  EXPECT_EQ(grid.height(0, 0), 0) << "heights that were there stay";
  EXPECT_EQ(readAll({path}).filled_posts, 0u);
}

// Every second column and a corner are missing: the plane is found again, but for its rim.
TEST(VoidFilling, a_plane_full_of_holes_becomes_the_plane) {
  const TemporaryDirectory folder;
  TestRaster raster = plane(64, 64);
  for (std::size_t k = 0; k < raster.values.size(); ++k) {
    const std::size_t row = k / 64, column = k % 64;
    const bool hole = row > 20 && row < 44 && column > 20 && column < 44;
    if (hole || column % 2 == 1) raster.values[k] = -32768;
  }
  raster.change = [](GDALDataset& dataset) { dataset.GetRasterBand(1)->SetNoDataValue(-32768); };
  const RawGrid grid = readOne(makeRaster(folder, raster), {.voids = VoidPolicy::kFill});
  EXPECT_TRUE(grid.valid.empty());
  for (std::int64_t row = 1; row < 63; ++row) {
    for (std::int64_t column = 1; column < 62; ++column)
      EXPECT_NEAR(grid.height(column, row), static_cast<double>(2 * column + 3 * row), 3)
          << column << ", " << row;
  }
}

// The plane at every third second, and at every second with a hole in its middle.
TEST(VoidFilling, a_void_over_another_grid_stays_and_shows_it) {
  const TemporaryDirectory folder;
  TestRaster coarse = plane(20, 20);
  coarse.transform = {-1.5 / 3600, 3.0 / 3600, 0, 58.5 / 3600, 0, -3.0 / 3600};
  for (double& height : coarse.values) height = height * 3 + 100;
  TestRaster fine = plane(58, 58);
  for (std::size_t k = 0; k < fine.values.size(); ++k) {
    const std::size_t row = k / 58, column = k % 58;
    if (row >= 20 && row < 40 && column >= 20 && column < 40) fine.values[k] = -32768;
  }
  fine.change = [](GDALDataset& dataset) { dataset.GetRasterBand(1)->SetNoDataValue(-32768); };
  const std::string below = makeRaster(folder, coarse, "coarse.tif");
  const std::string above = makeRaster(folder, fine, "fine.tif");
  const SourceArea area = readAll({below, above}, {.voids = VoidPolicy::kFill});
  ASSERT_EQ(area.grids.size(), 2u);
  EXPECT_EQ(area.filled_posts, 0u);
  EXPECT_FALSE(area.grids[0].isValid(25, 25));
  EXPECT_EQ(area.grids[0].header.sentinels, std::vector<double>{-32768});
}

// The lower grid has a hole of its own inside the upper one's: that alone is filled, with a rim one post wide
// that lies on the lower grid's ground.
TEST(VoidFilling, ground_is_made_up_only_where_no_grid_has_any) {
  const TemporaryDirectory folder;
  const auto nodata = [](GDALDataset& dataset) { dataset.GetRasterBand(1)->SetNoDataValue(-32768); };
  TestRaster coarse = plane(20, 20);
  coarse.transform = {-1.5 / 3600, 3.0 / 3600, 0, 58.5 / 3600, 0, -3.0 / 3600};
  for (double& height : coarse.values) height = height * 3 + 100;
  // Posts 9 .. 11 of both axes, so that facets are missing from 24" to 36".
  for (const std::size_t row : {8u, 9u, 10u}) {
    for (const std::size_t column : {9u, 10u, 11u}) coarse.values[row * 20 + column] = -32768;
  }
  coarse.change = nodata;
  TestRaster fine = plane(58, 58);
  for (std::size_t row = 17; row < 43; ++row) {
    for (std::size_t column = 15; column < 45; ++column) fine.values[row * 58 + column] = -32768;
  }
  fine.change = nodata;
  const SourceArea area = readAll({makeRaster(folder, coarse, "c.tif"), makeRaster(folder, fine, "f.tif")},
                                  {.voids = VoidPolicy::kFill});
  ASSERT_EQ(area.grids.size(), 2u);
  const RawGrid& upper = area.grids[0];
  EXPECT_EQ(upper.header.x_axis.count, 58);
  EXPECT_TRUE(upper.isValid(30, 30)) << "no grid has ground there";
  EXPECT_TRUE(upper.isValid(24, 30)) << "the rim, on the last post of the lower grid";
  EXPECT_EQ(upper.height(24, 30), 2 * 24 + 3 * 30 + 100) << "the lower grid's height";
  EXPECT_FALSE(upper.isValid(22, 30)) << "the lower grid's ground shows";
  EXPECT_FALSE(upper.isValid(38, 30));
  EXPECT_TRUE(area.grids[1].valid.empty()) << "the lower grid's hole is no one else's ground";
}

TEST(VoidFilling, the_error_of_resampling_holds_for_filled_posts_too) {
  const TemporaryDirectory folder;
  TestRaster raster = plane(60, 60);
  for (std::size_t k = 0; k < raster.values.size(); ++k) {
    const std::size_t row = k / 60, column = k % 60;
    // A lone peak in a wide void: no cell of the sources' surface touches it.
    if (row > 20 && row < 40 && column > 20 && column < 40) raster.values[k] = -32768;
    if (row == 30 && column == 30) raster.values[k] = 5000;
  }
  raster.change = [](GDALDataset& dataset) { dataset.GetRasterBand(1)->SetNoDataValue(-32768); };
  const RawGrid grid =
      readOne(makeRaster(folder, raster), {.spacing = PostSpacing{2.5, true}, .voids = VoidPolicy::kFill});
  ASSERT_TRUE(grid.header.resampling.has_value());
  EXPECT_TRUE(grid.valid.empty());
  EXPECT_GT(grid.header.resampling->largest_error, 4000);
}

TEST(Resampling, a_plane_stays_a_plane_and_the_error_is_that_of_rounding) {
  const TemporaryDirectory folder;
  const RawGrid grid = readOne(makeRaster(folder, plane(61, 61)), {.spacing = PostSpacing{2.5, true}});
  EXPECT_EQ(grid.header.x_axis.exact_spacing, (Rational{5, 2}));
  EXPECT_EQ(grid.header.x_axis.count, 25);
  EXPECT_EQ(grid.header.quantum, (Rational{1, 100}));
  ASSERT_TRUE(grid.header.resampling.has_value());
  EXPECT_LE(grid.header.resampling->largest_error, 0.005 + 1e-9);
  for (std::int64_t row = 0; row < 25; ++row) {
    for (std::int64_t column = 0; column < 25; ++column)
      EXPECT_EQ(grid.height(column, row),
                static_cast<std::int32_t>(
                    std::lround(100 * (5.0 * static_cast<double>(column) + 7.5 * static_cast<double>(row)))));
  }
}

TEST(Resampling, posts_that_fall_on_the_sources_keep_their_heights) {
  const TemporaryDirectory folder;
  TestRaster raster = plane(61, 61);
  for (std::size_t k = 0; k < raster.values.size(); ++k) raster.values[k] = static_cast<double>(k * k % 977);
  const std::string path = makeRaster(folder, raster);
  const RawGrid source = readOne(path),
                grid = readOne(path, {.quantum = Rational{1, 1}, .spacing = PostSpacing{3, true}});
  EXPECT_EQ(grid.header.height_error, 0);
  for (std::int64_t row = 0; row < grid.header.y_axis.count; ++row) {
    for (std::int64_t column = 0; column < grid.header.x_axis.count; ++column)
      EXPECT_EQ(grid.height(column, row), source.height(3 * column, 3 * row));
  }
  EXPECT_GT(grid.header.resampling->largest_error, 100) << "what lies between is lost, and it is said";
  EXPECT_GT(grid.header.resampling->largest_error, grid.header.resampling->rms_error);
}

TEST(Resampling, to_a_projection_and_back_the_surface_stays) {
  const TemporaryDirectory folder;
  TestRaster raster = plane(200, 200);
  raster.transform[0] += 3;
  raster.transform[3] += 45;
  const SourceArea area =
      readAll({makeRaster(folder, raster)}, {.grid = "EPSG:32631", .spacing = PostSpacing{20, false}});
  ASSERT_EQ(area.grids.size(), 1u);
  const RawGrid& grid = area.grids[0];
  EXPECT_EQ(grid.header.kind, "projected");
  ASSERT_TRUE(grid.patches);
  EXPECT_EQ(grid.header.x_axis.spacing, 20);
  EXPECT_LT(grid.header.resampling->largest_error, 0.02) << "a plane in degrees is nearly one in metres";
  // A post's height is that of the plane where the post lies.
  const GridGeometry geometry(grid.header, grid.patches);
  const std::int64_t i = grid.header.x_axis.first + grid.header.x_axis.count / 2,
                     j = grid.header.y_axis.first + grid.header.y_axis.count / 2;
  const GeodeticPoint point = geometry.geodeticAt(i, j);
  EXPECT_NEAR(grid.height(grid.header.x_axis.count / 2, grid.header.y_axis.count / 2) / 100.0,
              2 * (point.longitude - 3) * 3600 + 3 * (point.latitude - 45) * 3600, 0.006);
}

TEST(Resampling, a_globe_stays_whole_wherever_it_begins) {
  const TemporaryDirectory folder;
  for (const auto& [west, columns] : {std::pair{-180.0, 361}, {-180.0, 360}, {0.0, 360}, {-179.5, 360}}) {
    const RawGrid grid = readOne(makeRaster(folder, globe(west, columns)), {.grid = "geodetic"});
    EXPECT_EQ(grid.header.x_axis.count, 361) << west << ", " << columns;
    EXPECT_EQ(grid.header.x_axis.first, 0);
    EXPECT_TRUE(grid.valid.empty()) << west << ", " << columns;
    EXPECT_EQ(grid.height(0, 10), grid.height(360, 10));
  }
}

// A cone of 1 m for each kilometre from the pole, in the plane of a polar projection.
TestRaster cap(int posts, const char* crs) {
  TestRaster raster;
  raster.columns = raster.rows = posts;
  const double west = -0.5 * posts * 1000 + 300;
  raster.transform = {west, 1000, 0, -west - 600, 0, -1000};
  raster.crs = crs;
  for (int row = 0; row < posts; ++row) {
    for (int column = 0; column < posts; ++column)
      raster.values.push_back(
          std::round(0.01 * std::hypot(west + 1000 * (column + 0.5), west + 600 + 1000 * (row + 0.5))));
  }
  return raster;
}

TEST(Resampling, a_pole_inside_a_source_is_in_the_grid) {
  const TemporaryDirectory folder;
  for (const auto& [crs, south] : {std::pair{"EPSG:3031", true}, {"EPSG:3413", false}}) {
    const std::string path = makeRaster(folder, cap(100, crs));
    const RawGrid grid = readOne(path, {.grid = "geodetic", .spacing = PostSpacing{600, true}});
    EXPECT_EQ(grid.header.x_axis.count, 2161) << crs;
    EXPECT_EQ(grid.header.y_axis.count, 4) << "half a degree from the pole, and its corners";
    const std::int64_t pole = south ? 0 : 3;
    EXPECT_EQ(grid.header.y_axis.first + pole, south ? 0 : 1080);
    for (std::int64_t column = 0; column < 2161; column += 90) {
      ASSERT_TRUE(grid.isValid(column, pole));
      EXPECT_NEAR(grid.height(column, pole), 100 * 5, 500) << "on the cone's tip";
    }
  }
}

TEST(Resampling, bounds_round_the_earth_keep_a_pole) {
  const TemporaryDirectory folder;
  const RawGrid grid = readOne(
      makeRaster(folder, cap(300, "EPSG:3031")),
      {.bounds = SourceBounds{-180, -90, 180, -89}, .grid = "geodetic", .spacing = PostSpacing{600, true}});
  EXPECT_EQ(grid.header.x_axis.count, 2161);
  EXPECT_EQ(grid.header.y_axis.count, 7);
  EXPECT_TRUE(grid.valid.empty());
}

TEST(Resampling, near_a_pole_columns_are_spaced_by_metres_too) {
  const TemporaryDirectory folder;
  const RawGrid grid = readOne(makeRaster(folder, cap(300, "EPSG:3031")), {.grid = "geodetic"});
  EXPECT_EQ(grid.header.y_axis.exact_spacing, (Rational{30, 1}));
  EXPECT_EQ(grid.header.x_axis.exact_spacing, (Rational{900, 1}));
  EXPECT_EQ(grid.header.x_axis.count, 1441);
  EXPECT_LT(grid.heights.size(), 10u * 300 * 300);
}

TEST(Resampling, a_slip_of_the_spacing_is_refused_before_memory_is_taken) {
  const TemporaryDirectory folder;
  const std::string path = makeRaster(folder, plane(400, 400));
  const Result<RawGrid> fine = readElevationSource(path, {.spacing = PostSpacing{0.01, true}});
  ASSERT_FALSE(fine.ok());
  EXPECT_EQ(fine.error().kind, ErrorKind::kUsage);
  EXPECT_NE(fine.error().message().find("--bounds"), std::string::npos) << fine.error().message();
  // A part of it is as good as any.
  EXPECT_TRUE(readElevationSource(path, {.bounds = SourceBounds{0.01, 0.01, 0.0101, 0.0101},
                                         .spacing = PostSpacing{0.01, true}})
                  .ok());
}

TEST(Resampling, a_projection_that_folds_the_source_is_refused) {
  const TemporaryDirectory folder;
  const std::string path = makeRaster(folder, globe(-180, 361));
  const Result<RawGrid> folded = readElevationSource(path, {.grid = "EPSG:32610"});
  ASSERT_FALSE(folded.ok()) << "zone 10 has no place for the other side of the Earth";
  EXPECT_EQ(folded.error().kind, ErrorKind::kInvalid);
  EXPECT_TRUE(
      readElevationSource(path, {.bounds = SourceBounds{-130, -5, -115, 5}, .grid = "EPSG:32610"}).ok());
  EXPECT_TRUE(readElevationSource(path, {.grid = "EPSG:3395"}).ok());
}

TEST(Resampling, spacings_of_the_wrong_kind_are_refused) {
  const TemporaryDirectory folder;
  const std::string path = makeRaster(folder, plane(20, 20));
  EXPECT_EQ(readElevationSource(path, {.spacing = PostSpacing{30, false}}).error().kind, ErrorKind::kUsage);
  EXPECT_EQ(readElevationSource(path, {.grid = "EPSG:32631", .spacing = PostSpacing{1, true}}).error().kind,
            ErrorKind::kUsage);
  EXPECT_EQ(readElevationSource(path, {.grid = "nonsense"}).error().kind, ErrorKind::kUsage);
  EXPECT_EQ(readElevationSource(path, {.spacing = PostSpacing{300, true}}).error().kind, ErrorKind::kUsage);
}

}  // namespace
}  // namespace deltaz
