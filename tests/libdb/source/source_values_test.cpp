// Kinds of values a raster stores: what is kept, in which quantum, and what is void.
#include <cmath>
#include <gtest/gtest.h>
#include <limits>
#include <rapidcheck/gtest.h>

#include "libdb/source/stored_values.h"
#include "tests/libdb/source/test_rasters.h"

namespace deltaz {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

TestRaster rasterOf(GDALDataType type, std::vector<double> values) {
  TestRaster raster;
  raster.type = type;
  raster.values = std::move(values);
  raster.columns = static_cast<int>(raster.values.size()) / 2;
  raster.rows = 2;
  return raster;
}

// Stored values of a grid, from the north, as an export computes them; void posts give their sentinel.
std::vector<double> restored(const RawGrid& grid) {
  const SourceDescription& source = grid.header.sources.front();
  const StoredValues stored(source, *storedTypeOf(source.data_type), {1, 1}, grid.header.quantum);
  std::vector<double> values;
  for (std::int64_t row = grid.header.y_axis.count - 1; row >= 0; --row) {
    for (std::int64_t column = 0; column < grid.header.x_axis.count; ++column) {
      const auto post = static_cast<std::size_t>(row * grid.header.x_axis.count + column);
      const std::size_t kind = grid.void_kinds.empty() ? 0 : grid.void_kinds[post];
      values.push_back(grid.isValid(column, row) ? stored.storedOf(grid.heights[post])
                                                 : grid.header.sentinels.at(kind));
    }
  }
  return values;
}

TEST(SourceValues, floats_that_are_decimals_lose_nothing) {
  const TemporaryDirectory folder;
  const RawGrid grid =
      readOne(makeRaster(folder, rasterOf(GDT_Float32, {1234.1, 0.3, -7.2, 99.9, 8000.7, 0})));
  EXPECT_EQ(grid.header.quantum, (Rational{1, 10}));
  EXPECT_EQ(grid.header.height_error, 0);
  EXPECT_EQ(restored(grid)[0], static_cast<double>(1234.1f));
  EXPECT_EQ(restored(grid)[2], static_cast<double>(-7.2f));
}

TEST(SourceValues, floats_of_sixteenths_and_of_millimetres_lose_nothing) {
  const TemporaryDirectory folder;
  EXPECT_EQ(readOne(makeRaster(folder, rasterOf(GDT_Float32, {1.0625, 2.5, 3, 4.125}))).header.quantum,
            (Rational{1, 16}));
  EXPECT_EQ(readOne(makeRaster(folder, rasterOf(GDT_Float64, {1.001, 2.5, 3, 4.125}))).header.quantum,
            (Rational{1, 1000}));
}

TEST(SourceValues, other_floats_are_kept_to_half_a_centimetre_and_it_is_measured) {
  const TemporaryDirectory folder;
  const RawGrid grid =
      readOne(makeRaster(folder, rasterOf(GDT_Float64, {1.0004321, 2.7182818, 3.1415926, 4.0049})));
  EXPECT_EQ(grid.header.quantum, (Rational{1, 100}));
  EXPECT_NEAR(grid.header.height_error, 0.0049, 1e-12);
}

RC_GTEST_PROP(SourceValues, a_rounding_never_exceeds_half_a_quantum, ()) {
  const TemporaryDirectory folder;
  const auto raw = *rc::gen::container<std::vector<int>>(8, rc::gen::inRange(-900000000, 900000000));
  std::vector<double> values;
  for (const int value : raw) values.push_back(value / 123456.7);
  const RawGrid grid = readOne(makeRaster(folder, rasterOf(GDT_Float64, values)));
  const double quantum = grid.header.quantum.value();
  RC_ASSERT(grid.header.height_error <= quantum / 2 * (1 + 1e-9));
  double largest = 0;
  const std::vector<double> back = restored(grid);
  for (std::size_t k = 0; k < values.size(); ++k) largest = std::max(largest, std::abs(back[k] - values[k]));
  RC_ASSERT(std::abs(largest - grid.header.height_error) < 1e-9);
}

TEST(SourceValues, a_quantum_asked_for_is_taken_and_its_error_measured) {
  const TemporaryDirectory folder;
  const RawGrid grid =
      readOne(makeRaster(folder, rasterOf(GDT_Int16, {1, 2, 3, 4, 5, 7})), {.quantum = Rational{5, 2}});
  EXPECT_EQ(grid.header.quantum, (Rational{5, 2}));
  EXPECT_EQ(grid.header.height_error, 1.0);  // 1 m to 0, 4 m to 5 m
}

TEST(SourceValues, scale_and_offset_are_folded_into_heights_exactly) {
  const TemporaryDirectory folder;
  TestRaster raster = rasterOf(GDT_UInt16, {0, 1, 2, 40000, 65000, 65534});
  raster.change = [](GDALDataset& dataset) {
    dataset.GetRasterBand(1)->SetScale(0.1);
    dataset.GetRasterBand(1)->SetOffset(-1000.05);
  };
  const RawGrid grid = readOne(makeRaster(folder, raster));
  EXPECT_EQ(grid.header.quantum, (Rational{1, 20}));  // of 1/10 and 1000.05
  EXPECT_EQ(grid.header.height_error, 0);
  EXPECT_EQ(restored(grid), raster.values);
  EXPECT_DOUBLE_EQ(grid.height(0, 1) * grid.header.quantum.value(), -1000.05);
}

RC_GTEST_PROP(SourceValues, every_stored_value_comes_back_whatever_simple_scale_and_offset, ()) {
  SourceDescription source;
  source.scale = *rc::gen::element(1.0, 0.1, 0.01, 0.25, 0.125, -0.5, 2.0, 0.0625, 0.3048);
  source.offset = *rc::gen::element(0.0, 1000.0, -32.5, 0.05, 10.125);
  const double value = *rc::gen::inRange(-32768, 32768);
  const StoredType type = *storedTypeOf("Int16");
  const TemporaryDirectory folder;
  TestRaster raster = rasterOf(GDT_Int16, {value, 1, 2, 3});
  raster.change = [&](GDALDataset& dataset) {
    dataset.GetRasterBand(1)->SetScale(source.scale);
    dataset.GetRasterBand(1)->SetOffset(source.offset);
  };
  const RawGrid grid = readOne(makeRaster(folder, raster));
  RC_ASSERT(grid.header.height_error == 0);
  const StoredValues stored(source, type, {1, 1}, grid.header.quantum);
  if (grid.isValid(0, 1)) RC_ASSERT(stored.storedOf(grid.height(0, 1)) == value);
}

TEST(SourceValues, large_unsigned_and_64_bit_numbers_are_read) {
  const TemporaryDirectory folder;
  for (const GDALDataType type : {GDT_UInt32, GDT_Int64, GDT_UInt64}) {
    const std::vector<double> values = {0, 7, 900000000, 5};
    EXPECT_EQ(restored(readOne(makeRaster(folder, rasterOf(type, values)))), values);
  }
  const Result<RawGrid> far =
      readElevationSource(makeRaster(folder, rasterOf(GDT_UInt32, {1, 2, 3, 4000000000})), {});
  ASSERT_FALSE(far.ok());
  EXPECT_NE(far.error().message().find("4000000000"), std::string::npos) << far.error().message();
}

TEST(SourceValues, nan_is_void_beside_a_declared_sentinel_and_each_comes_back) {
  const TemporaryDirectory folder;
  TestRaster raster = rasterOf(GDT_Float32, {1, kNaN, -9999, 4, 5, 6});
  raster.change = [](GDALDataset& dataset) { dataset.GetRasterBand(1)->SetNoDataValue(-9999); };
  const RawGrid grid = readOne(makeRaster(folder, raster));
  EXPECT_FALSE(grid.isValid(1, 1));
  EXPECT_FALSE(grid.isValid(2, 1));
  EXPECT_EQ(grid.header.sentinels.size(), 2u);
  const std::vector<double> back = restored(grid);
  EXPECT_TRUE(std::isnan(back[1]));
  EXPECT_EQ(back[2], -9999);
}

TEST(SourceValues, a_customary_sentinel_far_from_its_neighbours_is_void_with_a_warning) {
  const TemporaryDirectory folder;
  for (const double sentinel : {-32768.0, -32767.0, -9999.0, 32767.0}) {
    std::vector<std::string> warnings;
    const RawGrid grid = readOne(
        makeRaster(folder, rasterOf(GDT_Int16, {1, 2, sentinel, sentinel, 5, 6, 7, 8})), {}, &warnings);
    EXPECT_FALSE(grid.isValid(2, 1)) << sentinel;
    ASSERT_EQ(warnings.size(), 1u);
    EXPECT_NE(warnings[0].find("2 posts"), std::string::npos) << warnings[0];
    EXPECT_EQ(restored(grid)[2], sentinel);
    EXPECT_EQ(grid.header.sources[0].nodata, std::nullopt) << "nothing was declared";
  }
  std::vector<std::string> warnings;
  const double lowest = -3.4028234663852886e38;
  const RawGrid grid = readOne(makeRaster(folder, rasterOf(GDT_Float32, {1.5, lowest, 3, 4})), {}, &warnings);
  EXPECT_FALSE(grid.isValid(1, 1));
  EXPECT_EQ(warnings.size(), 1u);
  EXPECT_EQ(restored(grid)[1], lowest);
}

TEST(SourceValues, a_customary_sentinel_among_heights_like_it_is_a_height) {
  const TemporaryDirectory folder;
  std::vector<std::string> warnings;
  const RawGrid grid = readOne(
      makeRaster(folder, rasterOf(GDT_Int16, {-9800, -9999, -9900, -10100, -9990, -9999, -9950, -9700})), {},
      &warnings);
  EXPECT_TRUE(grid.valid.empty());
  EXPECT_TRUE(warnings.empty());
}

TEST(SourceValues, a_nodata_value_given_by_the_user_wins) {
  const TemporaryDirectory folder;
  TestRaster raster = rasterOf(GDT_Int16, {1, 2, 3, 4});
  raster.change = [](GDALDataset& dataset) { dataset.GetRasterBand(1)->SetNoDataValue(2); };
  const RawGrid grid = readOne(makeRaster(folder, raster), {.nodata = 3.0});
  EXPECT_TRUE(grid.isValid(1, 1));
  EXPECT_FALSE(grid.isValid(0, 0));
}

TEST(SourceValues, posts_under_a_mask_and_transparent_ones_are_void) {
  const TemporaryDirectory folder;
  TestRaster alpha = rasterOf(GDT_Int16, {1, 2, 3, 4});
  alpha.bands = 2;
  alpha.prepare = [](GDALDataset& dataset) {
    dataset.GetRasterBand(1)->SetColorInterpretation(GCI_GrayIndex);
    dataset.GetRasterBand(2)->SetColorInterpretation(GCI_AlphaBand);
    std::vector<double> opaque = {255, 255, 0, 255};
    EXPECT_EQ(dataset.GetRasterBand(2)->RasterIO(GF_Write, 0, 0, 2, 2, opaque.data(), 2, 2, GDT_Float64, 0, 0,
                                                 nullptr),
              CE_None);
  };
  const RawGrid grid = readOne(makeRaster(folder, alpha));
  EXPECT_FALSE(grid.isValid(0, 0));
  EXPECT_TRUE(grid.isValid(1, 0));
  ASSERT_TRUE(grid.header.sources[0].nodata.has_value()) << "a mask becomes a nodata value";
  EXPECT_EQ(grid.header.sentinels, std::vector<double>{*grid.header.sources[0].nodata});

  TestRaster masked = rasterOf(GDT_Byte, {1, 2, 3, 4});
  masked.prepare = [](GDALDataset& dataset) {
    CPLSetThreadLocalConfigOption("GDAL_TIFF_INTERNAL_MASK", "YES");
    EXPECT_EQ(dataset.CreateMaskBand(GMF_PER_DATASET), CE_None);
    std::vector<double> seen = {255, 0, 255, 255};
    EXPECT_EQ(dataset.GetRasterBand(1)->GetMaskBand()->RasterIO(GF_Write, 0, 0, 2, 2, seen.data(), 2, 2,
                                                                GDT_Float64, 0, 0, nullptr),
              CE_None);
    CPLSetThreadLocalConfigOption("GDAL_TIFF_INTERNAL_MASK", nullptr);
  };
  EXPECT_FALSE(readOne(makeRaster(folder, masked)).isValid(1, 1));
}

TEST(SourceValues, one_band_of_several_is_read_when_named) {
  const TemporaryDirectory folder;
  TestRaster raster = rasterOf(GDT_Int16, {1, 2, 3, 4});
  raster.bands = 3;
  raster.prepare = [](GDALDataset& dataset) { dataset.GetRasterBand(2)->Fill(77); };
  const std::string path = makeRaster(folder, raster);
  EXPECT_EQ(readElevationSource(path, {}).error().kind, ErrorKind::kUsage);
  const RawGrid grid = readOne(path, {.band = 2});
  EXPECT_EQ(grid.height(0, 0), 77);
  EXPECT_EQ(grid.header.sources[0].band, 2);
  EXPECT_EQ(readElevationSource(path, {.band = 4}).error().kind, ErrorKind::kUsage);
}

TEST(SourceValues, a_source_of_nothing_but_a_customary_sentinel_is_warned_of) {
  const TemporaryDirectory folder;
  TestRaster raster;
  raster.type = GDT_Float32;
  raster.values.assign(20, -9999);
  std::vector<std::string> warnings;
  const RawGrid grid = readOne(makeRaster(folder, raster), {}, &warnings);
  EXPECT_TRUE(grid.valid.empty());
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_NE(warnings[0].find("--nodata"), std::string::npos) << warnings[0];
}

TEST(SourceValues, heights_that_are_none_on_earth_are_kept_with_a_warning) {
  const TemporaryDirectory folder;
  TestRaster raster;
  raster.values.assign(20, 100);
  std::vector<std::string> warnings;
  for (const double height : {-12000.0, 9000.0, -12001.0, 9001.0}) {
    raster.values[7] = height;
    const RawGrid grid = readOne(makeRaster(folder, raster), {}, &warnings);
    EXPECT_EQ(grid.height(2, 2), height);
    EXPECT_EQ(warnings.size(), std::abs(height) == 12000 || height == 9000 ? 0u : 1u) << height;
  }
}

}  // namespace
}  // namespace deltaz
