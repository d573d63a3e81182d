// Several files as one area: what is joined, what wins, and what stays apart.
#include "libdb/source/mosaic.h"

#include <gtest/gtest.h>

#include "tests/libdb/source/test_rasters.h"

namespace deltaz {
namespace {

// Posts at whole arc-seconds, the first of them at (west, south); heights are those of one surface, so that
// neighbours agree where they share posts.
TestRaster tileAt(int west, int south, int columns, int rows, int seconds = 1) {
  TestRaster raster;
  raster.columns = columns;
  raster.rows = rows;
  const double spacing = seconds / 3600.0;
  raster.transform = {(west - 0.5 * seconds) / 3600,           spacing, 0,
                      (south + (rows - 0.5) * seconds) / 3600, 0,       -spacing};
  for (int row = rows - 1; row >= 0; --row) {
    for (int column = 0; column < columns; ++column)
      raster.values.push_back((west + column * seconds) % 97 + 3 * ((south + row * seconds) % 89));
  }
  return raster;
}

std::int32_t surfaceHeight(std::int64_t west, std::int64_t south) {
  return static_cast<std::int32_t>(west % 97 + 3 * (south % 89));
}

TEST(Mosaic, neighbours_that_share_posts_become_one_grid_with_each_post_once) {
  const TemporaryDirectory folder;
  const SourceArea area = readAll({makeRaster(folder, tileAt(100, 40, 6, 5), "a.tif"),
                                   makeRaster(folder, tileAt(105, 40, 4, 5), "b.tif"),
                                   makeRaster(folder, tileAt(100, 44, 9, 3), "c.tif")});
  ASSERT_EQ(area.grids.size(), 1u);
  EXPECT_TRUE(area.warnings.empty());
  const RawGrid& grid = area.grids[0];
  EXPECT_EQ(grid.header.x_axis.count, 9);
  EXPECT_EQ(grid.header.y_axis.count, 7);
  EXPECT_EQ(grid.header.sources.size(), 3u);
  EXPECT_TRUE(grid.valid.empty());
  for (std::int64_t row = 0; row < 7; ++row) {
    for (std::int64_t column = 0; column < 9; ++column)
      EXPECT_EQ(grid.height(column, row), surfaceHeight(100 + column, 40 + row));
  }
}

TEST(Mosaic, tiles_without_shared_posts_join_when_no_post_lies_between) {
  const TemporaryDirectory folder;
  const SourceArea area = readAll({makeRaster(folder, tileAt(100, 40, 6, 5), "a.tif"),
                                   makeRaster(folder, tileAt(106, 40, 4, 5), "b.tif")});
  ASSERT_EQ(area.grids.size(), 1u);
  EXPECT_EQ(area.grids[0].header.x_axis.count, 10);
}

TEST(Mosaic, tiles_apart_are_grids_of_their_own) {
  const TemporaryDirectory folder;
  const SourceArea area = readAll({makeRaster(folder, tileAt(100, 40, 6, 5), "a.tif"),
                                   makeRaster(folder, tileAt(120, 40, 4, 5), "b.tif")});
  ASSERT_EQ(area.grids.size(), 2u);
  EXPECT_EQ(area.grids[0].header.sources[0].name, "a.tif");
}

TEST(Mosaic, the_earlier_source_wins_and_differences_are_told) {
  const TemporaryDirectory folder;
  TestRaster second = tileAt(105, 40, 4, 5);
  second.values[0] += 7;  // its north-west post, shared with the first
  second.values[3] += 9;  // its own
  const std::string a = makeRaster(folder, tileAt(100, 40, 6, 5), "a.tif"),
                    b = makeRaster(folder, second, "b.tif");
  const SourceArea area = readAll({a, b});
  ASSERT_EQ(area.warnings.size(), 1u);
  EXPECT_NE(area.warnings[0].find("1 of 5 posts"), std::string::npos) << area.warnings[0];
  EXPECT_NE(area.warnings[0].find("7 m"), std::string::npos) << area.warnings[0];
  EXPECT_EQ(area.grids[0].height(5, 4), surfaceHeight(105, 44));
  EXPECT_EQ(area.grids[0].height(8, 4), surfaceHeight(108, 44) + 9);
  EXPECT_EQ(readAll({b, a}).grids[0].height(5, 4), surfaceHeight(105, 44) + 7);
}

TEST(Mosaic, a_void_never_wins_over_a_height) {
  const TemporaryDirectory folder;
  TestRaster first = tileAt(100, 40, 6, 5);
  first.values[5] = -32768;  // north-east, shared
  first.values[0] = -32768;
  first.change = [](GDALDataset& dataset) { dataset.GetRasterBand(1)->SetNoDataValue(-32768); };
  const SourceArea area =
      readAll({makeRaster(folder, first, "a.tif"), makeRaster(folder, tileAt(105, 40, 4, 5), "b.tif")});
  ASSERT_EQ(area.grids.size(), 1u);
  EXPECT_TRUE(area.grids[0].isValid(5, 4));
  EXPECT_EQ(area.grids[0].height(5, 4), surfaceHeight(105, 44));
  EXPECT_FALSE(area.grids[0].isValid(0, 4));
}

TEST(Mosaic, what_no_source_covers_is_void) {
  const TemporaryDirectory folder;
  const SourceArea area = readAll({makeRaster(folder, tileAt(100, 40, 4, 4), "a.tif"),
                                   makeRaster(folder, tileAt(103, 43, 4, 4), "b.tif")});
  ASSERT_EQ(area.grids.size(), 1u);
  const RawGrid& grid = area.grids[0];
  EXPECT_FALSE(grid.isValid(6, 0));
  EXPECT_TRUE(grid.isValid(3, 3));
  ASSERT_EQ(grid.header.sentinels.size(), 1u);
  EXPECT_EQ(grid.header.sources[0].nodata, grid.header.sentinels[0]) << "an export needs a value for them";
}

TEST(Mosaic, tiles_on_both_sides_of_the_antimeridian_join) {
  const TemporaryDirectory folder;
  const SourceArea area = readAll({makeRaster(folder, tileAt(180 * 3600 - 5, 40, 6, 5), "a.tif"),
                                   makeRaster(folder, tileAt(-180 * 3600, 40, 4, 5), "b.tif")});
  ASSERT_EQ(area.grids.size(), 1u);
  EXPECT_EQ(area.grids[0].header.x_axis.count, 9);
  EXPECT_EQ(area.grids[0].header.x_axis.first, 360 * 3600 - 5);
}

TEST(Mosaic, a_finer_inset_is_a_grid_of_its_own_and_comes_first) {
  const TemporaryDirectory folder;
  const SourceArea area = readAll({makeRaster(folder, tileAt(99, 39, 6, 5, 3), "coarse.tif"),
                                   makeRaster(folder, tileAt(102, 42, 6, 5), "fine.tif")});
  ASSERT_EQ(area.grids.size(), 2u);
  EXPECT_EQ(area.grids[0].header.sources[0].name, "fine.tif");
}

TEST(Mosaic, files_of_different_quanta_join_in_a_common_one) {
  const TemporaryDirectory folder;
  TestRaster tenths = tileAt(100, 40, 6, 5), quarters = tileAt(105, 40, 4, 5);
  tenths.type = quarters.type = GDT_Float32;
  tenths.values[7] += 0.1;
  quarters.values[7] += 0.25;
  const SourceArea area =
      readAll({makeRaster(folder, tenths, "a.tif"), makeRaster(folder, quarters, "b.tif")});
  ASSERT_EQ(area.grids.size(), 1u);
  EXPECT_EQ(area.grids[0].header.quantum, (Rational{1, 20}));
  EXPECT_EQ(area.grids[0].height(0, 0), 20 * surfaceHeight(100, 40));
  EXPECT_EQ(area.grids[0].height(8, 3), 20 * surfaceHeight(108, 43) + 5);
}

TEST(Mosaic, heights_of_other_vertical_datums_are_told_apart) {
  const TemporaryDirectory folder;
  TestRaster first = tileAt(100, 40, 6, 5), second = tileAt(105, 40, 4, 5);
  first.crs = "EPSG:4326+5773";   // EGM96
  second.crs = "EPSG:4326+3855";  // EGM2008
  const SourceArea area = readAll({makeRaster(folder, first, "a.tif"), makeRaster(folder, second, "b.tif")});
  EXPECT_EQ(area.grids.size(), 2u);
  ASSERT_EQ(area.warnings.size(), 1u);
  EXPECT_NE(area.warnings[0].find("EGM"), std::string::npos) << area.warnings[0];
}

}  // namespace
}  // namespace deltaz
