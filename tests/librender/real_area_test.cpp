// Real DEMs: the sample always, more where DELTAZ_TEST_DATA names a folder with dem/.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <gtest/gtest.h>
#include <random>
#include <string>
#include <vector>

#include "librender/objects/terrain_object_processor.h"
#include "librender/raster/pretiler.h"
#include "tests/librender/picture_comparison.h"
#include "tests/librender/test_databases.h"

namespace deltaz {
namespace {

std::vector<std::string> demFiles(const std::vector<std::string>& further) {
  std::vector<std::string> files = {std::string(DELTAZ_SAMPLES) + "/mt_rainier.tif"};
  if (const char* folder = std::getenv("DELTAZ_TEST_DATA")) {
    for (const std::string& name : further) files.push_back(std::string(folder) + "/dem/" + name);
  }
  return files;
}

TEST(RealArea, vertices_handed_to_set_up_are_where_geographiclib_puts_them) {
  int areas = 0;
  for (const std::string& file : demFiles({"mt_everest_90m.tif", "N48W125.hgt.zip", "N00E010.hgt",
                                           "N42E001.hgt.zip", "n43.dt0", "n00_e006_3arc_v2.dt1"})) {
    const std::optional<MemoryDatabase> area = databaseOfFile(file);
    if (!area) continue;
    ++areas;
    const Database& database = area->database;
    const GridGeometry& geometry = database.grid(0);
    const std::vector<Node> nodes = nodesOfLevel(database, 0, 0).value();
    std::mt19937 random(1);
    double worst = 0;
    int posts = 0;
    while (posts < 10000) {
      const Node& node = nodes[random() % nodes.size()];
      if (node.record.isEmpty()) continue;
      const TerrainTile tile = database.terrain(node).value();
      const double x = static_cast<double>(random() % 1000) / 1000,
                   y = static_cast<double>(random() % 1000) / 1000;
      const double above = std::pow(10.0, 0.2 + static_cast<double>(random() % 500) / 100);
      Camera camera = cameraOver(database, x, y, above, static_cast<double>(random() % 360),
                                 -static_cast<double>(random() % 60), 1280, 720);
      const ViewTransform view = makeViewTransform(camera, geometry.header().ellipsoid);
      const std::vector<Vector3> position = terrainPositions(tile, geometry, view);
      for (int sample = 0; sample < 100; ++sample) {
        const int i = static_cast<int>(random() % static_cast<std::uint32_t>(tile.columns));
        const int j = static_cast<int>(random() % static_cast<std::uint32_t>(tile.rows));
        const Vector3& p = position[static_cast<std::size_t>(j * tile.columns + i)];
        // A post before the hither plane has no place on the screen.
        if (!tile.isValid(i, j) || p.x < 0.1) continue;
        const Vector3 truth =
            toEarthCentred(geometry.header().ellipsoid,
                           {geometry.latitude(tile.first_row + j), geometry.longitude(tile.first_column + i),
                            geometry.metres(tile.height(i, j))});
        const double error = length(unproject(view, project(view, p)) - truth);
        ASSERT_LE(error, 1e-3 + std::ldexp(length(truth - view.eye), -23));
        worst = std::max(worst, error);
        ++posts;
      }
    }
    std::printf("%s: largest position error %.3g m\n", file.c_str(), worst);
  }
  std::printf("%d real areas\n", areas);
}

TEST(RealArea, fast_and_reference_draw_the_same_pictures) {
  int areas = 0;
  for (const std::string& file : demFiles({"mt_everest_90m.tif", "N42E001.hgt.zip"})) {
    const std::optional<MemoryDatabase> area = databaseOfFile(file);
    if (!area) continue;
    ++areas;
    const Database& database = area->database;
    const std::vector<Camera> cameras = {wholeAreaCamera(database.area(), 1280, 720, 60),
                                         cameraOver(database, 0.30, 0.30, 1.7, 45, 2, 1280, 720),
                                         cameraOver(database, 0.62, 0.55, 60, 250, -4, 1280, 720),
                                         cameraOver(database, 0.45, 0.70, 900, 160, -8, 1280, 720)};
    for (const Camera& camera : cameras) {
      RenderOptions options;
      options.camera = camera;
      options.tolerance = 0;
      options.keep_triangle_ids = true;
      FrameStatistics fast_statistics, reference_statistics;
      const Picture fast = draw(EngineKind::kFast, database, options, fast_statistics);
      const Picture reference = draw(EngineKind::kReference, database, options, reference_statistics);
      const PictureDifference difference = comparePictures(database, camera, fast, reference);
      std::printf(
          "%s: %llu of %llu pixels differ by more than 2, coverage at %llu, at most %.5f px from an edge, "
          "depth of a triangle by %.3g; fast %.0f ms, reference %.0f ms\n",
          file.c_str(), static_cast<unsigned long long>(difference.differing),
          static_cast<unsigned long long>(difference.pixels),
          static_cast<unsigned long long>(difference.coverage), difference.farthest_from_edge,
          difference.largest_depth_difference, fast_statistics.milliseconds.total,
          reference_statistics.milliseconds.total);
      EXPECT_LE(static_cast<double>(difference.differing), 0.001 * static_cast<double>(difference.pixels));
      EXPECT_LE(difference.farthest_from_edge, 1.0 / 256);
    }
  }
  std::printf("%d real areas\n", areas);
}

}  // namespace
}  // namespace deltaz
