// Both engines on extreme grids and views: they draw, and they draw the same.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <gtest/gtest.h>

#include "libdb/access/ground_query.h"
#include "librender/scene/render.h"
#include "tests/librender/picture_comparison.h"
#include "tests/stress/bound_check.h"
#include "tests/stress/stress_grids.h"

namespace deltaz {
namespace {

constexpr double kSnapDistance = 1.0 / 256;  // pixels
constexpr double kDifferingShare = 0.001;    // of the pixels
constexpr double kDepthDifference = 1e-3;    // relative

RenderOptions optionsOf(const Camera& camera) {
  RenderOptions options;
  options.camera = camera;
  options.tolerance = 0;
  options.keep_triangle_ids = true;
  return options;
}

// An eye `above` metres over the ground in the middle of the area, or over its highest post where no ground
// is.
Camera cameraOverMiddle(const Database& database, double above, double heading, double pitch) {
  const AreaHeader& area = database.area();
  Camera camera;
  camera.eye = {(area.south + area.north) / 2, (area.west + area.east) / 2, area.highest_height};
  const auto ground = groundHeight(database, camera.eye.latitude, camera.eye.longitude);
  if (ground.ok() && ground.value()) camera.eye.height = *ground.value();
  camera.eye.height += above;
  camera.heading = heading;
  camera.pitch = pitch;
  camera.width = 160;
  camera.height = 100;
  return camera;
}

// Returns how many pixels show terrain.
std::ptrdiff_t expectSamePicture(const std::string& name, const Database& database, const Camera& camera) {
  FrameStatistics statistics;
  const RenderOptions options = optionsOf(camera);
  const Result<Picture> fast = makeEngine(EngineKind::kFast)->render(database, options, statistics);
  EXPECT_TRUE(fast.ok()) << name << ": " << (fast.ok() ? "" : fast.error().message());
  const Result<Picture> reference = makeEngine(EngineKind::kReference)->render(database, options, statistics);
  EXPECT_TRUE(reference.ok()) << name << ": " << (reference.ok() ? "" : reference.error().message());
  if (!fast.ok() || !reference.ok()) return 0;
  const PictureDifference difference = comparePictures(database, camera, fast.value(), reference.value());
  expectWithin(name + " differing pixels", static_cast<double>(difference.differing),
               kDifferingShare * static_cast<double>(difference.pixels));
  // The comparison places edges by latitude and longitude.
  if (database.grid(0).isGeodetic())
    expectWithin(name + " pixels from an edge", difference.farthest_from_edge, kSnapDistance);
  expectWithin(name + " relative depth", difference.largest_depth_difference, kDepthDifference);
  const std::vector<float>& depths = fast.value().depth;
  EXPECT_TRUE(std::none_of(depths.begin(), depths.end(), [](float depth) { return std::isnan(depth); }))
      << name;
  return std::count(fast.value().surface.begin(), fast.value().surface.end(), Surface::kTerrain);
}

// Two pictures of nothing would agree about anything.
bool hasFacet(const RawGrid& grid) {
  const TerrainTile tile = wholeTile(grid);
  for (int j = 0; j + 1 < tile.rows; ++j) {
    for (int i = 0; i + 1 < tile.columns; ++i) {
      if (tile.bottomFaceValid(i, j) || tile.topFaceValid(i, j)) return true;
    }
  }
  return false;
}

struct BuiltGrid {
  MemoryFileSystem files;
  Database database;
};

BuiltGrid built(const NamedGrid& named) {
  MemoryFileSystem files = buildInMemory(named.grid, {.leaf_cells = named.leaf_cells});
  Result<Database> database = Database::open(files, kMemoryDatabasePath);
  EXPECT_TRUE(database.ok());
  return {std::move(files), std::move(database).value()};
}

class ExtremePicture : public testing::TestWithParam<NamedGrid> {};

INSTANTIATE_TEST_SUITE_P(, ExtremePicture, testing::ValuesIn(extremeGrids()),
                         [](const auto& grid) { return grid.param.name; });

TEST_P(ExtremePicture, engines_agree_on_the_whole_area_and_from_above) {
  const NamedGrid& named = GetParam();
  const BuiltGrid area = built(named);
  const Database& database = area.database;
  Camera down = cameraOverMiddle(database, 100, 40, -90);
  down.field_of_view = 30;
  // Some of these grids are too thin for a pixel of the whole area, some too small to be seen from 100 m.
  const std::ptrdiff_t terrain =
      expectSamePicture(named.name + " whole area", database,
                        wholeAreaCamera(database.area(), 160, 100, 60)) +
      expectSamePicture(named.name + " from 500 m", database, cameraOverMiddle(database, 500, 40, -20)) +
      expectSamePicture(named.name + " straight down", database, down);
  EXPECT_EQ(terrain > 0, hasFacet(named.grid)) << terrain << " pixels of terrain";
}

// Any cut of any tree: a picture, and the error it was promised.
TEST_P(ExtremePicture, levels_of_detail_keep_the_tolerance) {
  const NamedGrid& named = GetParam();
  const BuiltGrid area = built(named);
  for (const double tolerance : {0.5, 4.0, 100.0}) {
    RenderOptions options = optionsOf(cameraOverMiddle(area.database, 500, 40, -20));
    options.tolerance = tolerance;
    FrameStatistics statistics;
    const Result<Picture> picture = makeEngine(EngineKind::kFast)->render(area.database, options, statistics);
    ASSERT_TRUE(picture.ok()) << picture.error().message();
    const std::vector<float>& depths = picture.value().depth;
    EXPECT_TRUE(std::none_of(depths.begin(), depths.end(), [](float depth) { return std::isnan(depth); }));
    expectWithin(named.name + " projected error, pixels", statistics.projected_error, tolerance);
  }
}

TEST(PictureExtremes, engines_agree_from_one_centimetre_to_ten_thousand_kilometres) {
  const BuiltGrid area = built(hills());
  for (const double above : {0.01, 0.1, 1.7, 100.0, 1e4, 1e6, 1e7}) {
    Camera camera = cameraOverMiddle(area.database, above, 65, above < 1e4 ? -8 : -90);
    // From far away through a telescope: the area is 10 km wide.
    if (above > 1e4) camera.field_of_view = std::atan(1e4 / above) * 180 / std::acos(-1.0);
    const std::string name = "eye " + std::to_string(above) + " m above ground";
    EXPECT_GT(expectSamePicture(name, area.database, camera), 0) << name;
  }
}

TEST(PictureExtremes, engines_agree_through_needles_and_panoramas) {
  const BuiltGrid area = built(hills());
  for (const double field_of_view : {0.001, 0.01, 170.0, 179.0}) {
    Camera camera = cameraOverMiddle(area.database, 2000, 20, -35);
    camera.field_of_view = field_of_view;
    const std::string name = "field of view " + std::to_string(field_of_view);
    EXPECT_GT(expectSamePicture(name, area.database, camera), 0) << name;
  }
  // A needle from very far away: the whole area is a few pixels at a field of view of a hundredth of a
  // degree.
  Camera camera = cameraOverMiddle(area.database, 1e7, 0, -90);
  camera.field_of_view = 0.01;
  EXPECT_GT(expectSamePicture("needle from ten thousand kilometres", area.database, camera), 0);
}

}  // namespace
}  // namespace deltaz
