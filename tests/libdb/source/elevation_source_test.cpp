#include "libdb/source/elevation_source.h"

#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <ogr_spatialref.h>

#include "tests/libdb/source/test_rasters.h"

namespace deltaz {
namespace {

Error refusal(const TestRaster& options) {
  const TemporaryDirectory folder;
  const Result<RawGrid> grid = readElevationSource(makeRaster(folder, options), {});
  if (grid.ok()) {
    ADD_FAILURE() << "accepted";
    return {};
  }
  return grid.error();
}

TEST(ElevationSource, posts_are_pixel_centres_for_both_registrations) {
  for (const char* const registration : {"Area", "Point"}) {
    const TemporaryDirectory folder;
    TestRaster options;
    options.change = [&](GDALDataset& dataset) {
      dataset.SetMetadataItem(GDALMD_AREA_OR_POINT, registration);
    };
    const Result<RawGrid> grid = readElevationSource(makeRaster(folder, options), {});
    ASSERT_TRUE(grid.ok()) << grid.error().message();
    EXPECT_EQ(grid.value().header.x_axis.first, 180 * 3600 - 80);
    EXPECT_EQ(grid.value().header.x_axis.phase, 0);
    EXPECT_EQ(grid.value().header.y_axis.first, 90 * 3600 + 40);
    EXPECT_EQ(grid.value().height(0, 0), 30) << "row 0 is the southern one";
    EXPECT_EQ(grid.value().height(4, 3), 4);
    EXPECT_EQ(grid.value().header.sources[0].point_registered, registration[0] == 'P');
  }
}

TEST(ElevationSource, south_up_rasters_are_turned) {
  const TemporaryDirectory folder;
  TestRaster options;
  options.transform = {-80.5 / 3600, 1.0 / 3600, 0, 39.5 / 3600, 0, 1.0 / 3600};
  const Result<RawGrid> grid = readElevationSource(makeRaster(folder, options), {});
  ASSERT_TRUE(grid.ok());
  EXPECT_EQ(grid.value().height(0, 0), 0);
  EXPECT_EQ(grid.value().header.y_axis.first, 90 * 3600 + 40);
}

TEST(ElevationSource, the_declared_sentinel_becomes_void) {
  const TemporaryDirectory folder;
  TestRaster options;
  options.change = [](GDALDataset& dataset) { dataset.GetRasterBand(1)->SetNoDataValue(22); };
  const Result<RawGrid> grid = readElevationSource(makeRaster(folder, options), {});
  ASSERT_TRUE(grid.ok());
  EXPECT_FALSE(grid.value().isValid(2, 1));
  EXPECT_TRUE(grid.value().isValid(2, 2));
  EXPECT_EQ(grid.value().header.sources[0].nodata, 22);
}

TEST(ElevationSource, feet_are_an_exact_quantum) {
  const TemporaryDirectory folder;
  TestRaster options;
  options.change = [](GDALDataset& dataset) { dataset.GetRasterBand(1)->SetUnitType("ft"); };
  const Result<RawGrid> grid = readElevationSource(makeRaster(folder, options), {});
  ASSERT_TRUE(grid.ok());
  EXPECT_EQ(grid.value().header.quantum, (Rational{381, 1250}));
}

// GDAL tells the unit of a vertical system only where the band names none.
TEST(ElevationSource, the_unit_of_the_vertical_system_counts) {
  const TemporaryDirectory folder;
  TestRaster options;
  options.crs.clear();
  const Result<RawGrid> grid = readElevationSource(makeRaster(folder, options), {.crs = "EPSG:4269+6360"});
  ASSERT_TRUE(grid.ok()) << grid.error().message();
  EXPECT_EQ(grid.value().header.quantum, (Rational{1200, 3937}));
}

// GDAL looks at the checksums of DTED records only when asked.
TEST(ElevationSource, a_damaged_dted_record_is_refused) {
  const TemporaryDirectory folder;
  const std::string path = folder.file("n43.dt0");
  GDALAllRegister();
  {
    GDALDatasetUniquePtr memory(
        GetGDALDriverManager()->GetDriverByName("MEM")->Create("", 121, 121, 1, GDT_Int16, nullptr));
    std::array<double, 6> transform = {-80 - 1.0 / 240, 1.0 / 120, 0, 44 + 1.0 / 240, 0, -1.0 / 120};
    memory->SetGeoTransform(transform.data());
    OGRSpatialReference reference;
    reference.SetFromUserInput("EPSG:4326");
    memory->SetSpatialRef(&reference);
    memory->GetRasterBand(1)->Fill(270);
    GDALDatasetUniquePtr dted(GetGDALDriverManager()->GetDriverByName("DTED")->CreateCopy(
        path.c_str(), memory.get(), FALSE, nullptr, nullptr, nullptr));
    ASSERT_TRUE(dted);
  }
  ASSERT_TRUE(readElevationSource(path, {}).ok());
  std::fstream file(path, std::ios::in | std::ios::out | std::ios::binary);
  file.seekp(3428 + 8 + 100);
  file.put(2);
  file.close();
  const Result<RawGrid> damaged = readElevationSource(path, {});
  ASSERT_FALSE(damaged.ok());
  EXPECT_EQ(damaged.error().kind, ErrorKind::kInvalid);
}

TEST(ElevationSource, other_ellipsoids_are_kept) {
  const TemporaryDirectory folder;
  TestRaster options;
  options.crs = "EPSG:4267";  // NAD27, Clarke 1866
  const Result<RawGrid> grid = readElevationSource(makeRaster(folder, options), {});
  ASSERT_TRUE(grid.ok());
  EXPECT_EQ(grid.value().header.ellipsoid.semi_major_axis, 6378206.4);
}

TEST(ElevationSource, what_is_not_read_is_refused_with_the_reason) {
  TestRaster options;
  options.transform[2] = 1e-5;
  EXPECT_NE(refusal(options).message().find("rotated"), std::string::npos);
  options = {};
  options.bands = 3;
  EXPECT_NE(refusal(options).message().find("3 bands"), std::string::npos);
  EXPECT_EQ(refusal(options).kind, ErrorKind::kUsage);
  options = {};
  options.type = GDT_CFloat32;
  EXPECT_NE(refusal(options).message().find("CFloat32"), std::string::npos);
  options = {};
  options.crs = "EPSG:4807";  // from Paris, in grads
  EXPECT_EQ(refusal(options).kind, ErrorKind::kInvalid);
  options = {};
  options.type = GDT_Byte;
  options.prepare = [](GDALDataset& dataset) {
    GDALColorTable colors;
    const GDALColorEntry green = {0, 255, 0, 255};
    colors.SetColorEntry(1, &green);
    dataset.GetRasterBand(1)->SetColorTable(&colors);
  };
  EXPECT_NE(refusal(options).message().find("colour table"), std::string::npos);
  options = {};
  options.transform[1] = 1e-10;
  EXPECT_NE(refusal(options).message().find("apart"), std::string::npos);
  options = {};
  options.change = [](GDALDataset& dataset) {
    dataset.GetRasterBand(1)->SetNoDataValue(7);
    dataset.GetRasterBand(1)->Fill(7);
  };
  EXPECT_NE(refusal(options).message().find("every post is void"), std::string::npos);
}

TEST(ElevationSource, a_row_on_the_pole_is_accepted_and_one_beyond_refused) {
  const TemporaryDirectory folder;
  TestRaster options;
  options.transform = {0, 1, 0, 90.5, 0, -1};
  EXPECT_TRUE(readElevationSource(makeRaster(folder, options), {}).ok());
  options.transform[3] = 91.5;
  EXPECT_NE(refusal(options).message().find("latitude"), std::string::npos);
}

TEST(ElevationSource, a_source_without_crs_wants_one) {
  const TemporaryDirectory folder;
  TestRaster options;
  options.crs.clear();
  const std::string path = makeRaster(folder, options);
  const Result<RawGrid> refused = readElevationSource(path, {});
  ASSERT_FALSE(refused.ok());
  EXPECT_EQ(refused.error().kind, ErrorKind::kUsage);
  EXPECT_NE(refused.error().message().find("--crs"), std::string::npos);
  EXPECT_TRUE(readElevationSource(path, {.crs = "EPSG:4326"}).ok());
  EXPECT_EQ(readElevationSource(path, {.crs = "EPSG:no"}).error().kind, ErrorKind::kUsage);
}

TEST(ElevationSource, missing_empty_and_foreign_files_are_told_apart) {
  const TemporaryDirectory folder;
  EXPECT_EQ(readElevationSource(folder.file("none.tif"), {}).error().kind, ErrorKind::kCannotAccess);
  std::ofstream(folder.file("empty.tif")).close();
  EXPECT_NE(readElevationSource(folder.file("empty.tif"), {}).error().message().find("empty"),
            std::string::npos);
  std::ofstream(folder.file("text.tif")) << "This is not a raster.\n";
  EXPECT_EQ(readElevationSource(folder.file("text.tif"), {}).error().kind, ErrorKind::kInvalid);
  EXPECT_EQ(readElevationSource(folder.path(), {}).error().kind, ErrorKind::kInvalid);
}

TEST(ElevationSource, a_file_cut_short_is_refused) {
  const TemporaryDirectory folder;
  const std::string path = makeRaster(folder);
  std::filesystem::resize_file(path, std::filesystem::file_size(path) - 30);
  EXPECT_FALSE(readElevationSource(path, {}).ok());
}

TEST(ElevationSource, the_slit_of_a_grid_that_goes_round_the_earth_is_closed) {
  const TemporaryDirectory folder;
  TestRaster raster;
  raster.columns = 360;
  raster.rows = 4;
  raster.transform = {-180, 1, 0, 2, 0, -1};
  raster.values.assign(360 * 4, 100);
  raster.values[0] = -32768;
  raster.values[360] = 7;
  raster.change = [](GDALDataset& dataset) { dataset.GetRasterBand(1)->SetNoDataValue(-32768); };
  const RawGrid grid = readOne(makeRaster(folder, raster));
  ASSERT_EQ(grid.header.x_axis.count, 361);
  ASSERT_EQ(grid.heights.size(), 361u * 4);
  EXPECT_FALSE(grid.isValid(360, 3));
  EXPECT_EQ(grid.height(360, 2), 7);
  EXPECT_EQ(grid.height(0, 2), 7);
  EXPECT_EQ(grid.height(359, 2), 100);
  raster.columns = 359;
  raster.values.assign(359 * 4, 100);
  EXPECT_EQ(readOne(makeRaster(folder, raster)).header.x_axis.count, 359) << "a column is missing there";
}

TEST(ElevationSource, the_coordinates_of_a_rotated_pole_are_not_taken_for_latitudes) {
  TestRaster raster;
  raster.crs = "+proj=ob_tran +o_proj=longlat +o_lon_p=0 +o_lat_p=37.5 +lon_0=10 +datum=WGS84 +type=crs";
  const Error error = refusal(raster);
  EXPECT_EQ(error.kind, ErrorKind::kInvalid);
  EXPECT_NE(error.message().find("gdalwarp"), std::string::npos) << error.message();
}

TEST(ElevationSource, what_arithmetic_left_of_a_rotation_is_none) {
  const TemporaryDirectory folder;
  TestRaster raster;
  raster.transform[2] = 1e-18;
  raster.transform[4] = -1e-13;
  const RawGrid grid = readOne(makeRaster(folder, raster));
  EXPECT_EQ(grid.header.x_axis.spacing, 1.0 / 3600);
  EXPECT_EQ(grid.header.sources[0].geotransform[2], 1e-18) << "and an export has it again";
}

// A sixth of a degree written with ten decimals, all round the Earth and from pole to pole.
TEST(ElevationSource, rounded_georeferencing_that_reaches_beyond_the_pole_is_placed_exactly) {
  const TemporaryDirectory folder;
  TestRaster raster;
  raster.columns = 2161;
  raster.rows = 1081;
  raster.transform = {-180.08333333335, 0.1666666667, 0, 90.08333333335, 0, -0.1666666667};
  raster.values.assign(2161 * 1081, 5);
  std::vector<std::string> warnings;
  const RawGrid grid = readOne(makeRaster(folder, raster), {}, &warnings);
  EXPECT_EQ(grid.header.y_axis.exact_spacing, (Rational{600, 1}));
  EXPECT_EQ(grid.header.y_axis.first, 0);
  EXPECT_EQ(grid.header.x_axis.exact_spacing, (Rational{600, 1}));
  EXPECT_EQ(grid.header.x_axis.first, 0);
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_NE(warnings[0].find("rounded"), std::string::npos);
  raster.transform = {-180.083335, 0.16667, 0, 90.083335, 0, -0.16667};
  const Result<RawGrid> far = readElevationSource(makeRaster(folder, raster, "far.tif"), {});
  ASSERT_FALSE(far.ok()) << "that is two hundredths of a cell";
  EXPECT_NE(far.error().message().find("-a_ullr"), std::string::npos) << far.error().message();
}

}  // namespace
}  // namespace deltaz
