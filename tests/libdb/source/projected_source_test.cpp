// Projected sources and changes of datum: where the posts come to lie on the Earth.
#include <GeographicLib/UTMUPS.hpp>
#include <cmath>
#include <gtest/gtest.h>

#include "libdb/access/grid_geometry.h"
#include "libdb/access/patch_surface.h"
#include "libdb/source/patch_fitting.h"
#include "libdb/source/reference_system.h"
#include "tests/libdb/source/test_rasters.h"

namespace deltaz {
namespace {

TestRaster utmRaster(int columns, int rows, double spacing = 30, double west = 557820,
                     double north = 5121990) {
  TestRaster raster;
  raster.crs = "EPSG:32610";
  raster.columns = columns;
  raster.rows = rows;
  raster.transform = {west - spacing / 2, spacing, 0, north + spacing / 2, 0, -spacing};
  return raster;
}

TEST(ProjectedSource, posts_keep_their_own_coordinates) {
  const TemporaryDirectory folder;
  const RawGrid grid = readOne(makeRaster(folder, utmRaster(40, 30)));
  EXPECT_EQ(grid.header.kind, "projected");
  ASSERT_TRUE(grid.patches);
  const GridGeometry geometry(grid.header, grid.patches);
  EXPECT_EQ(geometry.xCoordinate(grid.header.x_axis.first), 557820);
  EXPECT_EQ(geometry.yCoordinate(grid.header.y_axis.first), 5121990 - 29 * 30);
}

// GeographicLib's transverse Mercator is not PROJ's.
TEST(ProjectedSource, posts_of_a_utm_grid_lie_where_geographiclib_says) {
  const TemporaryDirectory folder;
  const RawGrid grid = readOne(makeRaster(folder, utmRaster(1500, 1200, 90)));
  EXPECT_LE(grid.header.patches->error, kPatchErrorAim);
  const GridGeometry geometry(grid.header, grid.patches);
  double largest = 0;
  for (std::int64_t row = 0; row < 1200; row += 37) {
    for (std::int64_t column = 0; column < 1500; column += 41) {
      const std::int64_t x = grid.header.x_axis.first + column, y = grid.header.y_axis.first + row;
      double latitude = 0, longitude = 0;
      GeographicLib::UTMUPS::Reverse(10, true, geometry.xCoordinate(x), geometry.yCoordinate(y), latitude,
                                     longitude);
      const Vector3 exact = toEarthCentred(grid.header.ellipsoid, {latitude, longitude, 0});
      largest = std::max(largest, length(geometry.placeAt(x, y).foot - exact));
    }
  }
  EXPECT_LE(largest, kPatchErrorAim);
  RecordProperty("largest", std::to_string(largest));
}

// Not at the positions the error was measured at.
TEST(ProjectedSource, the_stated_error_of_patches_holds_everywhere) {
  const TemporaryDirectory folder;
  for (const char* const crs :
       {"EPSG:3857", "EPSG:2154", "EPSG:2193", "EPSG:3031", "EPSG:3035", "EPSG:27700"}) {
    TestRaster raster = utmRaster(700, 900, 250);
    raster.crs = crs;
    const bool polar = std::string(crs) == "EPSG:3031";
    const double x = polar ? -90000 : std::string(crs) == "EPSG:2193" ? 1500000 : 400000;
    const double y = polar                              ? 110000
                     : std::string(crs) == "EPSG:2154"  ? 6700000
                     : std::string(crs) == "EPSG:2193"  ? 5400000
                     : std::string(crs) == "EPSG:27700" ? 400000
                                                        : 3200000;
    raster.transform = {x, 250, 0, y, 0, -250};
    const std::string path = makeRaster(folder, raster, "dem.tif");
    const RawGrid grid = readOne(path);
    ASSERT_TRUE(grid.patches) << crs;
    const auto system = parseReferenceSystem(crs, "test");
    ASSERT_TRUE(system.ok());
    const auto geographic = geographicOf(system.value(), "test");
    ASSERT_TRUE(geographic.ok());
    const auto change = CoordinateChange::between(system.value(), geographic.value(), false, "test");
    ASSERT_TRUE(change.ok());
    const GridGeometry geometry(grid.header, grid.patches);
    double largest = 0;
    for (std::int64_t row = 0; row < 900; row += 23) {
      for (std::int64_t column = 0; column < 700; column += 19) {
        const std::int64_t i = grid.header.x_axis.first + column, j = grid.header.y_axis.first + row;
        std::vector<double> lon = {geometry.xCoordinate(i)}, lat = {geometry.yCoordinate(j)};
        ASSERT_TRUE(change.value().apply(lon, lat));
        const Vector3 exact = toEarthCentred(grid.header.ellipsoid, {lat[0], lon[0], 0});
        largest = std::max(largest, length(geometry.placeAt(i, j).foot - exact));
      }
    }
    EXPECT_LE(largest, grid.header.patches->error) << crs;
    EXPECT_LE(grid.header.patches->error, kPatchErrorAim)
        << crs << ", patches of " << grid.header.patches->cells;
  }
}

TEST(ProjectedSource, posts_without_a_place_on_the_earth_are_refused) {
  const TemporaryDirectory folder;
  TestRaster raster = utmRaster(40, 30);
  raster.crs = "EPSG:3035";
  raster.transform = {5e7, 1000, 0, 5e7, 0, -1000};
  const Result<RawGrid> refused = readElevationSource(makeRaster(folder, raster), {});
  ASSERT_FALSE(refused.ok());
  EXPECT_NE(refused.error().message().find("placed"), std::string::npos) << refused.error().message();
}

TEST(ProjectedSource, another_crs_than_the_sources_is_used_with_a_warning) {
  const TemporaryDirectory folder;
  std::vector<std::string> warnings;
  const std::string path = makeRaster(folder, utmRaster(40, 30));
  const RawGrid grid = readOne(path, {.crs = "EPSG:32611"}, &warnings);
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_NE(warnings[0].find("--crs"), std::string::npos);
  EXPECT_NE(grid.header.crs_wkt.find("zone 11N"), std::string::npos);
  (void)readOne(path, {.crs = "EPSG:32610"}, &warnings);
  EXPECT_TRUE(warnings.empty()) << "the same system in other words";
}

TEST(DatumChange, a_second_source_comes_to_the_firsts_datum) {
  const TemporaryDirectory folder;
  TestRaster nad27 = utmRaster(40, 30);
  nad27.crs = "EPSG:26710";
  TestRaster wgs84 = utmRaster(40, 30, 30, 557820 + 30 * 100);
  const SourceArea area = readAll({makeRaster(folder, wgs84, "a.tif"), makeRaster(folder, nad27, "b.tif")});
  ASSERT_EQ(area.grids.size(), 2u);
  EXPECT_EQ(area.grids[0].header.ellipsoid, area.grids[1].header.ellipsoid);
  EXPECT_EQ(area.grids[0].header.horizontal_datum, area.grids[1].header.horizontal_datum);
  ASSERT_EQ(area.warnings.size(), 1u);
  EXPECT_NE(area.warnings[0].find("accurate to"), std::string::npos) << area.warnings[0];
  // The same coordinates in NAD27 are some 100 m away on the ground.
  const RawGrid alone = readOne(makeRaster(folder, nad27, "c.tif"), {.crs = "EPSG:32610"});
  const GridGeometry shifted(area.grids[1].header, area.grids[1].patches), plain(alone.header, alone.patches);
  const double apart = length(shifted.placeAt(shifted.columnsAt(0).begin, shifted.rowsAt(0).begin).foot -
                              plain.placeAt(plain.columnsAt(0).begin, plain.rowsAt(0).begin).foot);
  EXPECT_GT(apart, 50);
  EXPECT_LT(apart, 300);
}

TEST(DatumChange, latitudes_of_another_datum_become_a_projected_grid) {
  const TemporaryDirectory folder;
  TestRaster first, second;
  first.transform = {-122, 1.0 / 1200, 0, 46, 0, -1.0 / 1200};
  second.transform = {-121, 1.0 / 1200, 0, 46, 0, -1.0 / 1200};
  second.crs = "EPSG:4267";
  const SourceArea area = readAll({makeRaster(folder, first, "a.tif"), makeRaster(folder, second, "b.tif")});
  ASSERT_EQ(area.grids.size(), 2u);
  EXPECT_EQ(area.grids[0].header.kind, "geodetic");
  EXPECT_EQ(area.grids[1].header.kind, "projected");
  const GridGeometry geometry(area.grids[1].header, area.grids[1].patches);
  EXPECT_NEAR(geometry.xCoordinate(geometry.columnsAt(0).begin), -121 + 0.5 / 1200, 1e-9);
}

TEST(DatumChange, a_guess_is_refused_unless_asked_for) {
  const TemporaryDirectory folder;
  TestRaster first, second;
  first.transform = {-122, 1.0 / 1200, 0, 46, 0, -1.0 / 1200};
  second.transform = {-121, 1.0 / 1200, 0, 46, 0, -1.0 / 1200};
  // A datum nothing is known of.
  second.crs =
      "GEOGCS[\"Nowhere\",DATUM[\"Nowhere_1900\",SPHEROID[\"Clarke 1866\",6378206.4,294.9786982138982]],"
      "PRIMEM[\"Greenwich\",0],UNIT[\"degree\",0.0174532925199433]]";
  const std::vector<std::string> paths = {makeRaster(folder, first, "a.tif"),
                                          makeRaster(folder, second, "b.tif")};
  const Result<SourceArea> refused = readElevationSources(paths, {});
  ASSERT_FALSE(refused.ok());
  EXPECT_EQ(refused.error().kind, ErrorKind::kInvalid);
  EXPECT_NE(refused.error().message().find("--allow-ballpark"), std::string::npos)
      << refused.error().message();
  const SourceArea area = readAll(paths, {.allow_ballpark = true});
  ASSERT_EQ(area.warnings.size(), 1u);
  EXPECT_NE(area.warnings[0].find("guess"), std::string::npos);
}

}  // namespace
}  // namespace deltaz
