#include "librender/objects/report_objects.h"

#include <algorithm>
#include <array>
#include <gtest/gtest.h>
#include <set>
#include <stdexcept>

#include "libdb/build/build_terrain.h"
#include "tests/librender/test_databases.h"

namespace deltaz {
namespace {

// A tile of the area, seen from high above its middle: no face is turned away.
struct SeenTile {
  TerrainTile tile;
  ViewTransform view;
  std::vector<Vector3> position;
  GridGeometry geometry;
};

SeenTile seen(const Database& database, int columns_at_least = 0) {
  const Camera camera = cameraOver(database, 0.5, 0.5, 1e6, 0, -90, 512, 512);
  const ViewTransform view = makeViewTransform(camera, EllipsoidShape{});
  for (const Node& node : nodesOfLevel(database, 0, 0).value()) {
    TerrainTile tile = database.terrain(node).value();
    if (tile.columns < columns_at_least) continue;
    std::vector<Vector3> position = terrainPositions(tile, database.grid(0), view);
    return {std::move(tile), view, std::move(position), database.grid(0)};
  }
  throw std::runtime_error("no such tile");
}

SyntheticGridOptions gentle(int columns, int rows) {
  SyntheticGridOptions options = smallArea();
  options.columns = columns;
  options.rows = rows;
  options.lowest = 500;
  options.highest = 520;
  return options;
}

// Every object of the tile at these levels.
std::vector<ReportObject> objectsAt(const SeenTile& seen, ReportLevels levels) {
  std::vector<ReportObject> objects =
      reportObjects(seen.tile, seen.position, seen.view, ReportRanges({}, seen.view, seen.geometry));
  for (ReportObject& object : objects) object.levels = levels;
  return objects;
}

std::set<std::uint32_t> postsOf(const TerrainFaces& faces) {
  std::set<std::uint32_t> posts;
  for (const TerrainFace& face : faces.front) posts.insert(face.vertex.begin(), face.vertex.end());
  return posts;
}

// Twice the area of the faces, in cells of the tile.
int doubledCells(const TerrainTile& tile, const TerrainFaces& faces) {
  int cells = 0;
  for (const TerrainFace& face : faces.front) {
    const auto i = [&](int k) {
      return static_cast<int>(face.vertex[static_cast<std::size_t>(k)]) % tile.columns;
    };
    const auto j = [&](int k) {
      return static_cast<int>(face.vertex[static_cast<std::size_t>(k)]) / tile.columns;
    };
    const int turn = (i(1) - i(0)) * (j(2) - j(0)) - (i(2) - i(0)) * (j(1) - j(0));
    EXPECT_GT(turn, 0);
    cells += turn;
  }
  return cells;
}

TEST(ReportObjects, have_81_45_25_15_and_9_posts) {
  const MemoryDatabase area = makeDatabase(gentle(9, 9));
  const SeenTile tile = seen(area.database);
  ASSERT_EQ(tile.tile.columns, 9);
  const std::array<std::size_t, kReportLevels> posts = {81, 45, 25, 15, 9};
  std::set<std::uint32_t> of_finer;
  for (int level = 1; level <= kReportLevels; ++level) {
    const std::vector<ReportObject> objects = objectsAt(tile, {level, level});
    ASSERT_EQ(objects.size(), 1u);
    FrameStatistics::Objects counts;
    const TerrainFaces faces = reportFaces(tile.tile, tile.position, objects, counts);
    EXPECT_EQ(faces.in, std::uint64_t{128} >> (level - 1));
    EXPECT_EQ(faces.back_facing, 0u);
    EXPECT_EQ(counts.faces[static_cast<std::size_t>(level - 1)], faces.in);
    EXPECT_EQ(counts.faces_twice, 0u);
    EXPECT_EQ(doubledCells(tile.tile, faces), 128);
    const std::set<std::uint32_t> kept = postsOf(faces);
    EXPECT_EQ(kept.size(), posts[static_cast<std::size_t>(level - 1)]);
    if (level > 1) {
      EXPECT_TRUE(std::includes(of_finer.begin(), of_finer.end(), kept.begin(), kept.end())) << level;
    }
    of_finer = kept;
  }
}

TEST(ReportObjects, lose_every_other_column_first) {
  EXPECT_EQ(reportStep(2).columns, 2);
  EXPECT_EQ(reportStep(2).rows, 1);
  EXPECT_EQ(reportStep(4).columns, 4);
  EXPECT_EQ(reportStep(4).rows, 2);
}

TEST(ReportObjects, of_two_levels_are_drawn_at_both) {
  const MemoryDatabase area = makeDatabase(gentle(9, 9));
  const SeenTile tile = seen(area.database);
  FrameStatistics::Objects counts;
  const TerrainFaces faces = reportFaces(tile.tile, tile.position, objectsAt(tile, {2, 3}), counts);
  EXPECT_EQ(faces.in, 64u + 32u);
  EXPECT_EQ(counts.drawn, 1u);
  EXPECT_EQ(counts.drawn_twice, 1u);
  EXPECT_EQ(counts.faces[1], 64u);
  EXPECT_EQ(counts.faces[2], 0u);
  EXPECT_EQ(counts.faces_twice, 32u);
}

TEST(ReportObjects, cover_a_tile_that_ends_between_multiples) {
  const MemoryDatabase area = makeDatabase(gentle(14, 12));
  const SeenTile tile = seen(area.database, 14);
  ASSERT_EQ(tile.tile.columns, 14);
  ASSERT_EQ(tile.tile.rows, 12);
  for (int level = 1; level <= kReportLevels; ++level) {
    FrameStatistics::Objects counts;
    const std::vector<ReportObject> objects = objectsAt(tile, {level, level});
    EXPECT_EQ(objects.size(), 4u);
    const TerrainFaces faces = reportFaces(tile.tile, tile.position, objects, counts);
    EXPECT_EQ(doubledCells(tile.tile, faces), 2 * 13 * 11);
  }
}

TEST(ReportObjects, stay_at_the_finest_level_where_posts_are_void_or_faces_replaced) {
  const MemoryDatabase area = makeDatabase(gentle(17, 9));
  SeenTile tile = seen(area.database, 17);
  const ReportLod coarsest{1, 0.495, 0};
  const ReportRanges ranges(coarsest, tile.view, tile.geometry);
  std::vector<std::uint8_t> replaced(2 * 16 * 8, 0);
  const auto levels = [&](std::size_t object) {
    return reportObjects(tile.tile, tile.position, tile.view, ranges, replaced)[object].levels.finest;
  };
  EXPECT_EQ(levels(0), kReportLevels);
  EXPECT_EQ(levels(1), kReportLevels);
  replaced[2 * 3] = 1;  // cell (3, 0)
  EXPECT_EQ(levels(0), 1);
  EXPECT_EQ(levels(1), kReportLevels);
  tile.tile.valid[tile.tile.index(12, 5)] = 0;
  EXPECT_EQ(levels(1), 1);
  FrameStatistics::Objects counts;
  const TerrainFaces faces =
      reportFaces(tile.tile, tile.position,
                  reportObjects(tile.tile, tile.position, tile.view, ranges, replaced), counts, replaced);
  EXPECT_EQ(faces.in, 2u * 128 - 6 - 1);
}

TEST(ReportObjects, out_of_view_are_not_drawn) {
  const MemoryDatabase area = makeDatabase(gentle(17, 9));
  SeenTile tile = seen(area.database, 17);
  // Close above the western end, looking straight down.
  const Camera camera = cameraOver(area.database, 0.05, 0.5, 100, 0, -90, 64, 64);
  tile.view = makeViewTransform(camera, EllipsoidShape{});
  tile.position = terrainPositions(tile.tile, tile.geometry, tile.view);
  const auto objects =
      reportObjects(tile.tile, tile.position, tile.view, ReportRanges({}, tile.view, tile.geometry));
  ASSERT_EQ(objects.size(), 2u);
  EXPECT_TRUE(objects[0].in_view);
  EXPECT_FALSE(objects[1].in_view);
  FrameStatistics::Objects counts;
  EXPECT_EQ(reportFaces(tile.tile, tile.position, objects, counts).in, 128u);
  EXPECT_EQ(counts.drawn, 1u);
  EXPECT_EQ(counts.out_of_view, 1u);
}

// Views of the small area whose nearest ground is some hundred metres away and whose farthest ten kilometres.
std::vector<Camera> viewsOf(const Database& database) {
  return {cameraOver(database, 0.5, 0.1, 300, 0, -10, 200, 150),
          cameraOver(database, 0.5, 0.5, 2000, 70, -60, 200, 150),
          cameraOver(database, 0.3, 0.4, 2, 140, 0, 200, 150)};
}

TEST(ReportLod, at_the_first_level_is_the_picture_of_full_resolution) {
  for (const int leaf_cells : {16, 64}) {
    const MemoryDatabase area = makeDatabase(smallArea(), leaf_cells);
    for (const Camera& camera : viewsOf(area.database)) {
      RenderOptions options;
      options.camera = camera;
      options.keep_triangle_ids = true;
      options.tolerance = 0;
      const Picture full = draw(EngineKind::kFast, area.database, options);
      options.lod = LodScheme::kReport;
      options.report_lod.first_range = 1e9;
      options.tolerance = 5;
      const Picture by_range = draw(EngineKind::kFast, area.database, options);
      EXPECT_EQ(by_range.rgb, full.rgb);
      EXPECT_EQ(by_range.depth, full.depth);
      EXPECT_EQ(by_range.triangle, full.triangle);
    }
  }
}

// Seams stand on faces of full resolution, whatever the range.
TEST(ReportLod, draws_grids_that_overlap_as_one_ground) {
  SyntheticGridOptions inset = smallArea();
  inset.seed = 2;
  inset.south = 46.83;
  inset.west = -121.77;
  inset.columns = 145;
  inset.rows = 121;
  inset.spacing_latitude = inset.spacing_longitude = {1, 1};
  BuildOptions build;
  build.leaf_cells = 16;
  MemoryFileSystem files;
  ASSERT_TRUE(files.makeDirectory("/folder").ok());
  const std::vector<RawGrid> grids = {syntheticGrid(inset), syntheticGrid(smallArea())};
  ASSERT_TRUE(buildTerrain(files, grids, kMemoryDatabasePath, build).ok());
  const Database database = Database::open(files, kMemoryDatabasePath).value();
  ASSERT_EQ(database.seams().size(), 1u);
  for (const Camera& camera : viewsOf(database)) {
    RenderOptions options;
    options.camera = camera;
    options.tolerance = 0;
    const Picture full = draw(EngineKind::kFast, database, options);
    options.lod = LodScheme::kReport;
    options.report_lod.first_range = 1e9;
    EXPECT_EQ(draw(EngineKind::kFast, database, options).rgb, full.rgb);
    options.report_lod.first_range = 1;
    FrameStatistics statistics;
    const Picture coarse = draw(EngineKind::kFast, database, options, statistics);
    EXPECT_NE(coarse.rgb, full.rgb);
    // Objects that a seam touches, and those alone.
    EXPECT_GT(statistics.objects.faces[0], 0u);
    EXPECT_GT(statistics.objects.faces[4], 0u);
    EXPECT_EQ(statistics.objects.faces[1] + statistics.objects.faces[2] + statistics.objects.faces[3], 0u);
  }
}

TEST(ReportLod, accounts_for_every_face_and_draws_the_same_picture_on_any_number_of_threads) {
  const MemoryDatabase area = makeDatabase(smallArea(), 64);
  for (const Camera& camera : viewsOf(area.database)) {
    RenderOptions options;
    options.camera = camera;
    options.lod = LodScheme::kReport;
    options.report_lod.first_range = 3000;
    FrameStatistics statistics;
    options.threads = 1;
    const Picture one = draw(EngineKind::kFast, area.database, options, statistics);
    const FrameStatistics::Triangles& triangles = statistics.triangles;
    EXPECT_EQ(triangles.in,
              triangles.back_facing + triangles.clipped + triangles.no_sample + triangles.drawn);
    const FrameStatistics::Objects& objects = statistics.objects;
    std::uint64_t faces = objects.faces_twice;
    for (const std::uint64_t of_level : objects.faces) faces += of_level;
    EXPECT_EQ(triangles.in, faces);
    EXPECT_GT(objects.drawn, 0u);
    for (const int threads : {2, 7}) {
      options.threads = threads;
      FrameStatistics again;
      const Picture picture = draw(EngineKind::kFast, area.database, options, again);
      EXPECT_EQ(picture.rgb, one.rgb);
      EXPECT_EQ(picture.depth, one.depth);
      EXPECT_EQ(again.objects.faces, objects.faces);
      EXPECT_EQ(again.objects.drawn_twice, objects.drawn_twice);
    }
  }
}

TEST(ReportLod, draws_fewer_faces_the_farther_away_and_some_twice) {
  const MemoryDatabase area = makeDatabase(smallArea(), 64);
  RenderOptions options;
  options.camera = cameraOver(area.database, 0.5, 0.1, 300, 0, -5, 200, 150);
  options.lod = LodScheme::kReport;
  FrameStatistics fine, coarse;
  options.report_lod.first_range = 1e9;
  draw(EngineKind::kFast, area.database, options, fine);
  options.report_lod.first_range = 10000;  // a picture this small sees level 2 from 2.9 km
  draw(EngineKind::kFast, area.database, options, coarse);
  EXPECT_LT(coarse.triangles.in, fine.triangles.in);
  EXPECT_GT(coarse.objects.drawn_twice, 0u);
  EXPECT_GT(coarse.objects.faces_twice, 0u);
  EXPECT_GT(coarse.objects.faces[0], 0u);
  EXPECT_GT(coarse.objects.faces[1], 0u);
  EXPECT_EQ(coarse.objects.drawn, fine.objects.drawn);
}

}  // namespace
}  // namespace deltaz
