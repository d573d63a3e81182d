#include "libdb/export/export_terrain.h"

#include <filesystem>
#include <gtest/gtest.h>

#include "libdb/build/build_terrain.h"
#include "tests/support/synthetic_grid.h"
#include "tests/support/temporary_directory.h"

namespace deltaz {
namespace {

Database openSample(const MemoryFileSystem& files) {
  Result<Database> database = Database::open(files, kMemoryDatabasePath);
  EXPECT_TRUE(database.ok());
  return std::move(database).value();
}

TEST(ExportTerrain, the_exported_file_reads_as_the_same_grid) {
  SyntheticGridOptions options;
  options.voids = VoidPattern::kHole;
  const RawGrid grid = syntheticGrid(options);
  const MemoryFileSystem files = buildInMemory(grid);
  const TemporaryDirectory folder;
  const Status exported = exportTerrain(openSample(files), folder.file("dem.tif"), {});
  ASSERT_TRUE(exported.ok()) << exported.error().message();
  const Result<RawGrid> back = readElevationSource(folder.file("dem.tif"), {});
  ASSERT_TRUE(back.ok()) << back.error().message();
  EXPECT_EQ(back.value().header.x_axis, grid.header.x_axis);
  EXPECT_EQ(back.value().header.y_axis, grid.header.y_axis);
  EXPECT_EQ(back.value().header.quantum, grid.header.quantum);
  EXPECT_EQ(back.value().header.sources[0].geotransform, grid.header.sources[0].geotransform);
  EXPECT_EQ(back.value().header.sources[0].data_type, grid.header.sources[0].data_type);
  for (std::int64_t row = 0; row < grid.header.y_axis.count; ++row) {
    for (std::int64_t column = 0; column < grid.header.x_axis.count; ++column) {
      ASSERT_EQ(back.value().isValid(column, row), grid.isValid(column, row));
      if (grid.isValid(column, row)) {
        ASSERT_EQ(back.value().height(column, row), grid.height(column, row));
      }
    }
  }
}

TEST(ExportTerrain, the_coordinate_epoch_is_kept) {
  RawGrid grid = syntheticGrid();
  grid.header.coordinate_epoch = 2021.3;
  const MemoryFileSystem files = buildInMemory(grid);
  const TemporaryDirectory folder;
  ASSERT_TRUE(exportTerrain(openSample(files), folder.file("dem.tif"), {}).ok());
  const Result<RawGrid> back = readElevationSource(folder.file("dem.tif"), {});
  ASSERT_TRUE(back.ok());
  EXPECT_EQ(back.value().header.coordinate_epoch, 2021.3);
}

TEST(ExportTerrain, each_void_holds_what_its_source_held) {
  SyntheticGridOptions options;
  options.voids = VoidPattern::kScattered;
  RawGrid grid = syntheticGrid(options);
  grid.header.sentinels = {-32768, -9999, -32767};
  grid.header.sources.front().nodata = -32768;
  grid.void_kinds.assign(grid.heights.size(), 0);
  std::size_t seen = 0;
  for (std::size_t k = 0; k < grid.valid.size(); ++k) {
    if (grid.valid[k] == 0) grid.void_kinds[k] = static_cast<std::uint8_t>(seen++ % 3);
  }
  ASSERT_GT(seen, 9u);
  const MemoryFileSystem files = buildInMemory(grid, {.leaf_cells = 16});
  const TemporaryDirectory folder;
  const Status exported = exportTerrain(openSample(files), folder.file("dem.tif"), {});
  ASSERT_TRUE(exported.ok()) << exported.error().message();
  const Result<SourceArea> back = readElevationSources(std::vector<std::string>{folder.file("dem.tif")}, {});
  ASSERT_TRUE(back.ok()) << back.error().message();
  const RawGrid& again = back.value().grids.front();
  ASSERT_EQ(again.valid, grid.valid);
  EXPECT_EQ(back.value().warnings.size(), 2u) << "one sentinel is declared, two are not";
  for (std::size_t k = 0; k < grid.valid.size(); ++k) {
    if (grid.valid[k] != 0) continue;
    ASSERT_EQ(again.header.sentinels.at(again.void_kinds[k]), grid.header.sentinels[grid.void_kinds[k]]);
  }
}

TEST(ExportTerrain, scale_offset_and_unit_are_those_of_the_source) {
  RawGrid grid = syntheticGrid();
  SourceDescription& source = grid.header.sources.front();
  source.data_type = "Int32";
  source.unit = "ft";
  source.scale = 0.1;
  source.offset = 50;
  grid.header.quantum = {381, 12500};  // a tenth of a foot
  const MemoryFileSystem files = buildInMemory(grid);
  const TemporaryDirectory folder;
  const Status exported = exportTerrain(openSample(files), folder.file("dem.tif"), {});
  ASSERT_TRUE(exported.ok()) << exported.error().message();
  const Result<RawGrid> back = readElevationSource(folder.file("dem.tif"), {});
  ASSERT_TRUE(back.ok()) << back.error().message();
  EXPECT_EQ(back.value().header.sources[0].scale, 0.1);
  EXPECT_EQ(back.value().header.sources[0].offset, 50);
  EXPECT_EQ(back.value().header.sources[0].unit, "ft");
  EXPECT_EQ(back.value().header.quantum, grid.header.quantum);
  EXPECT_EQ(back.value().heights, grid.heights);
}

TEST(ExportTerrain, a_coarser_level_keeps_its_posts_in_place) {
  const RawGrid grid = syntheticGrid();
  const MemoryFileSystem files = buildInMemory(grid, {.leaf_cells = 16});
  const TemporaryDirectory folder;
  ASSERT_TRUE(exportTerrain(openSample(files), folder.file("dem.tif"), {.level = 2}).ok());
  const Result<RawGrid> back = readElevationSource(folder.file("dem.tif"), {});
  ASSERT_TRUE(back.ok()) << back.error().message();
  const GridGeometry fine(grid.header), coarse(back.value().header);
  const std::int64_t first = grid.header.x_axis.first;
  const std::int64_t skipped = ceilDivide(first, 4) * 4 - first;
  EXPECT_NEAR(coarse.longitude(back.value().header.x_axis.first), fine.longitude(first + skipped), 1e-10);
  EXPECT_EQ(back.value().height(0, 0),
            grid.height(skipped, ceilDivide(grid.header.y_axis.first, 4) * 4 - grid.header.y_axis.first));
}

TEST(ExportTerrain, an_existing_file_is_kept_unless_overwriting) {
  const MemoryFileSystem files = buildInMemory(syntheticGrid());
  const TemporaryDirectory folder;
  ASSERT_TRUE(exportTerrain(openSample(files), folder.file("dem.tif"), {}).ok());
  EXPECT_EQ(exportTerrain(openSample(files), folder.file("dem.tif"), {}).error().kind, ErrorKind::kUsage);
  EXPECT_TRUE(exportTerrain(openSample(files), folder.file("dem.tif"), {.overwrite = true}).ok());
  EXPECT_EQ(exportTerrain(openSample(files), folder.file("none/dem.tif"), {}).error().kind,
            ErrorKind::kCannotAccess);
  EXPECT_EQ(exportTerrain(openSample(files), folder.path(), {.overwrite = true}).error().kind,
            ErrorKind::kUsage);
  EXPECT_EQ(exportTerrain(openSample(files), folder.file("b.tif"), {.grid = 1}).error().kind,
            ErrorKind::kUsage);
  EXPECT_EQ(exportTerrain(openSample(files), folder.file("b.tif"), {.level = 9}).error().kind,
            ErrorKind::kUsage);
  // Nothing but the one file: no temporary one is left.
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path()), {}), 1);
}

}  // namespace
}  // namespace deltaz
