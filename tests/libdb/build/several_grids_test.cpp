// Areas of several grids and of projected ones: every post comes back, stored bounds hold, old files go.
#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <map>

#include "libdb/access/content_digest.h"
#include "libdb/access/database.h"
#include "libdb/access/ground_query.h"
#include "libdb/access/plan_shape.h"
#include "libdb/access/vertex_normals.h"
#include "libdb/build/area_bounds.h"
#include "libdb/build/build_terrain.h"
#include "libdb/check/check.h"
#include "tests/support/projected_grid.h"
#include "tests/support/synthetic_grid.h"

namespace deltaz {
namespace {

MemoryFileSystem emptyFolder() {
  MemoryFileSystem files;
  EXPECT_TRUE(files.makeDirectory("/folder").ok());
  return files;
}

void expectClean(const FileSystem& files) {
  const Report report = checkDatabase(files, kMemoryDatabasePath, {});
  for (const IssueGroup& group : report.groups)
    ADD_FAILURE() << issueCodeName(group.code) << ": " << group.first.front().message;
  EXPECT_TRUE(report.complete);
}

void expectPosts(const Database& database, int grid_number, const RawGrid& grid) {
  std::int64_t seen = 0;
  const auto leaves = nodesOfLevel(database, grid_number, 0);
  ASSERT_TRUE(leaves.ok());
  for (const Node& leaf : leaves.value()) {
    const Result<TerrainTile> read = database.terrain(leaf);
    ASSERT_TRUE(read.ok()) << read.error().message();
    const TerrainTile& tile = read.value();
    for (int j = 0; j < tile.rows; ++j) {
      for (int i = 0; i < tile.columns; ++i) {
        const std::int64_t column = tile.first_column + i - grid.header.x_axis.first;
        const std::int64_t row = tile.first_row + j - grid.header.y_axis.first;
        ASSERT_EQ(tile.isValid(i, j), grid.isValid(column, row));
        if (tile.isValid(i, j)) {
          ASSERT_EQ(tile.height(i, j), grid.height(column, row));
        }
        ++seen;
      }
    }
  }
  EXPECT_GE(seen, grid.header.x_axis.count * grid.header.y_axis.count);
}

std::vector<RawGrid> insetInArea() {
  SyntheticGridOptions wide;
  wide.columns = 200;
  wide.rows = 150;
  SyntheticGridOptions fine;
  fine.west = -79.5;
  fine.south = 43.3;
  fine.spacing_latitude = fine.spacing_longitude = {10, 1};
  fine.seed = 2;
  fine.quantum = {1, 2};
  fine.voids = VoidPattern::kHole;
  std::vector<RawGrid> grids;
  grids.push_back(syntheticGrid(fine));
  grids.push_back(syntheticGrid(wide));
  grids.push_back(projectedGrid({.easting = 700000, .columns = 70, .rows = 90}));
  return grids;
}

TEST(SeveralGrids, all_of_them_come_back_and_the_area_is_sound) {
  const MemoryFileSystem files = emptyFolder();
  const std::vector<RawGrid> grids = insetInArea();
  const auto built = buildTerrain(files, grids, kMemoryDatabasePath, {.leaf_cells = 16});
  ASSERT_TRUE(built.ok()) << built.error().message();
  expectClean(files);
  Result<Database> database = Database::open(files, kMemoryDatabasePath);
  ASSERT_TRUE(database.ok()) << database.error().message();
  ASSERT_EQ(database.value().gridCount(), 3);
  for (int grid = 0; grid < 3; ++grid)
    expectPosts(database.value(), grid, grids[static_cast<std::size_t>(grid)]);
  const AreaHeader& area = database.value().area();
  EXPECT_EQ(area.west, -80);
  EXPECT_EQ(area.south, 43);
  // Every grid's coarsest nodes come first.
  for (std::uint32_t number = 5; number <= 8; ++number)
    EXPECT_EQ(database.value().record(number).value().type, NodeType::kTerrain);
  std::vector<bool> seen(3, false);
  for (std::uint32_t number = 1; number <= std::min(16u, area.node_count); ++number) {
    const NodeRecord record = database.value().record(number).value();
    if (record.type == NodeType::kTerrain) seen[record.grid] = true;
  }
  EXPECT_EQ(std::count(seen.begin(), seen.end(), true), 3);
}

TEST(SeveralGrids, bytes_do_not_depend_on_the_number_of_threads) {
  const std::vector<RawGrid> grids = insetInArea();
  const MemoryFileSystem one = emptyFolder(), several = emptyFolder();
  ASSERT_TRUE(buildTerrain(one, grids, kMemoryDatabasePath, {.leaf_cells = 16, .threads = 1}).ok());
  ASSERT_TRUE(buildTerrain(several, grids, kMemoryDatabasePath, {.leaf_cells = 16, .threads = 7}).ok());
  const std::vector<std::string> names = one.list(kMemoryDatabasePath).value();
  EXPECT_TRUE(std::any_of(names.begin(), names.end(), [](const auto& n) { return n.ends_with(".dzp"); }));
  for (const std::string& name : names)
    EXPECT_EQ(one.bytes(kMemoryDatabasePath + "/" + name), several.bytes(kMemoryDatabasePath + "/" + name));
}

TEST(SeveralGrids, different_ellipsoids_are_refused) {
  std::vector<RawGrid> grids = insetInArea();
  grids[1].header.ellipsoid = {6378206.4, 294.978698213898};
  const auto built = buildTerrain(emptyFolder(), grids, kMemoryDatabasePath, {});
  ASSERT_FALSE(built.ok());
  EXPECT_EQ(built.error().kind, ErrorKind::kUsage);
  EXPECT_FALSE(buildTerrain(emptyFolder(), std::span<const RawGrid>{}, kMemoryDatabasePath, {}).ok());
}

TEST(SeveralGrids, a_projected_grid_without_its_control_points_is_refused) {
  RawGrid grid = projectedGrid();
  grid.patches = nullptr;
  EXPECT_FALSE(buildTerrain(emptyFolder(), grid, kMemoryDatabasePath, {}).ok());
}

TEST(SeveralGrids, an_overwrite_takes_the_old_control_points_away) {
  const MemoryFileSystem files = emptyFolder();
  ASSERT_TRUE(buildTerrain(files, projectedGrid(), kMemoryDatabasePath, {}).ok());
  ASSERT_TRUE(buildTerrain(files, projectedGrid({.seed = 5}), kMemoryDatabasePath, {.overwrite = true}).ok());
  expectClean(files);
}

TEST(SeveralGrids, area_bounds_take_the_short_way_round) {
  SyntheticGridOptions west, east;
  west.west = 179.5;
  west.columns = 61;
  east.west = -179.5;
  east.columns = 61;
  const RawGrid a = syntheticGrid(east), b = syntheticGrid(west);
  const GridGeometry first(a.header), second(b.header);
  const std::array<const GridGeometry*, 2> grids = {&first, &second};
  const DegreeBounds bounds = boundsOf(grids);
  EXPECT_DOUBLE_EQ(bounds.west, 179.5);
  EXPECT_DOUBLE_EQ(bounds.east, 181);
}

TEST(SeveralGrids, where_grids_overlap_the_first_wins_a_ground_query) {
  const MemoryFileSystem files = emptyFolder();
  std::vector<RawGrid> grids = insetInArea();
  ASSERT_TRUE(buildTerrain(files, grids, kMemoryDatabasePath, {}).ok());
  Result<Database> database = Database::open(files, kMemoryDatabasePath);
  const double fine = grids[0].height(3, 4) * 0.5;
  const auto height = groundHeight(database.value(), 43.3 + 40.0 / 3600, -79.5 + 30.0 / 3600);
  ASSERT_TRUE(height.ok());
  ASSERT_TRUE(height.value().has_value());
  EXPECT_NEAR(*height.value(), fine, 1e-6);
}

TEST(ProjectedGrid, ground_height_at_every_post_is_the_post) {
  const MemoryFileSystem files = emptyFolder();
  const RawGrid grid = projectedGrid({.easting = 730000, .northing = 6600000, .voids = VoidPattern::kHole});
  ASSERT_TRUE(buildTerrain(files, grid, kMemoryDatabasePath, {.leaf_cells = 16}).ok());
  Result<Database> database = Database::open(files, kMemoryDatabasePath);
  const GridGeometry& geometry = database.value().grid(0);
  int asked = 0;
  for (std::int64_t row = 1; row < 120; row += 13) {
    for (std::int64_t column = 1; column < 120; column += 11) {
      const GeodeticPoint place =
          geometry.geodeticAt(grid.header.x_axis.first + column, grid.header.y_axis.first + row);
      const auto height = groundHeight(database.value(), place.latitude, place.longitude);
      ASSERT_TRUE(height.ok());
      if (!grid.isValid(column, row)) continue;
      if (!height.value()) continue;  // beside voids a post may belong to no facet
      EXPECT_NEAR(*height.value(), grid.height(column, row), 1e-5);
      ++asked;
    }
  }
  EXPECT_GT(asked, 50);
  EXPECT_FALSE(groundHeight(database.value(), 0, 0).value().has_value());
  EXPECT_FALSE(groundHeight(database.value(), -59, 100).value().has_value());
  const DegreeBounds bounds = boundsOf(geometry);
  EXPECT_FALSE(groundHeight(database.value(), bounds.south - 0.01, bounds.west).value().has_value());
}

TEST(ProjectedGrid, neighbours_give_shared_posts_the_same_normals) {
  const MemoryFileSystem files = emptyFolder();
  ASSERT_TRUE(buildTerrain(files, projectedGrid({.voids = VoidPattern::kScattered}), kMemoryDatabasePath,
                           {.leaf_cells = 16})
                  .ok());
  Result<Database> database = Database::open(files, kMemoryDatabasePath);
  const GridGeometry& geometry = database.value().grid(0);
  for (int level = 0; level < geometry.header().level_count; ++level) {
    std::map<std::pair<std::int64_t, std::int64_t>, Vector3> seen;
    std::size_t shared = 0;
    for (const Node& node : nodesOfLevel(database.value(), 0, level).value()) {
      const TerrainTile tile = database.value().terrain(node).value();
      const std::vector<Vector3> normals = vertexNormals(tile, geometry);
      for (int j = 0; j < tile.rows; ++j) {
        for (int i = 0; i < tile.columns; ++i) {
          const Vector3& normal = normals[static_cast<std::size_t>(j * tile.columns + i)];
          const auto [place, fresh] = seen.try_emplace({tile.first_column + i, tile.first_row + j}, normal);
          if (fresh) continue;
          EXPECT_EQ(place->second, normal);
          ++shared;
        }
      }
    }
    EXPECT_GT(shared, 10u);
  }
}

TEST(ProjectedGrid, lines_of_posts_stay_within_the_stated_bow) {
  const RawGrid grid = projectedGrid({.easting = 250000, .northing = 7000000, .spacing = 200});
  const GridGeometry geometry(grid.header, grid.patches);
  const PostRange columns = geometry.columnsAt(0), rows = geometry.rowsAt(0);
  const SidewaysBow bow(geometry);
  for (int level = 2; level <= 5; ++level) {
    const std::int64_t step = std::int64_t{1} << level;
    double widest = 0;
    for (const auto& [di, dj] : {std::array<std::int64_t, 2>{1, 0}, {0, 1}, {1, 1}}) {
      for (std::int64_t j = rows.begin; j + dj * step < rows.end; j += 7) {
        for (std::int64_t i = columns.begin; i + di * step < columns.end; i += 7) {
          const Vector3 from = geometry.placeAt(i, j).foot;
          const Vector3 to = geometry.placeAt(i + di * step, j + dj * step).foot;
          const PostPlace middle = geometry.placeAt(i + di * step / 2, j + dj * step / 2);
          widest =
              std::max(widest, std::abs(dot(middle.foot - from, normalized(cross(to - from, middle.up)))));
        }
      }
    }
    EXPECT_LE(widest, bow.at(level, rows));
    EXPECT_GE(widest, 0.4 * bow.at(level, rows)) << "a bound so far off says nothing";
  }
}

TEST(ProjectedGrid, one_control_point_moved_changes_the_content_digest) {
  RawGrid grid = projectedGrid();
  const auto digest = [&] {
    const MemoryFileSystem files = emptyFolder();
    EXPECT_TRUE(buildTerrain(files, grid, kMemoryDatabasePath, {}).ok());
    return contentDigest(Database::open(files, kMemoryDatabasePath).value()).value();
  };
  const Hash128 before = digest();
  EXPECT_EQ(before, digest());
  auto moved = std::make_shared<PatchLattice>(*grid.patches);
  moved->controls[0] += 1e-7;
  grid.patches = moved;
  EXPECT_NE(before, digest());
}

}  // namespace
}  // namespace deltaz
