#include "libdb/build/place_models.h"

#include <gtest/gtest.h>
#include <limits>

#include "libdb/access/database.h"
#include "libdb/access/ground_query.h"
#include "libdb/build/placement_writer.h"
#include "tests/support/model_fixture.h"
#include "tests/support/synthetic_grid.h"

namespace deltaz {
namespace {

PlacementRequest at(double latitude, double longitude) {
  PlacementRequest request;
  request.latitude = latitude;
  request.longitude = longitude;
  request.where = "--at";
  return request;
}

MemoryFileSystem withModel() {
  MemoryFileSystem files = buildInMemory(syntheticGrid());
  addFixtureModel(files, kMemoryDatabasePath);
  return files;
}

Result<std::vector<Placement>> put(const FileSystem& files, const std::vector<PlacementRequest>& requests) {
  return placeModels(files, kMemoryDatabasePath, kFixtureModelName, requests);
}

TEST(PlaceModels, without_an_altitude_the_model_stands_on_the_ground) {
  const MemoryFileSystem files = withModel();
  ASSERT_TRUE(put(files, {at(43.4321, -79.5678)}).ok());
  const Result<Database> database = Database::open(files, kMemoryDatabasePath);
  ASSERT_TRUE(database.ok());
  const Placement placement = database.value().placements()->all().value().front();
  EXPECT_TRUE(placement.on_ground);
  EXPECT_EQ(placement.height, *groundHeight(database.value(), 43.4321, -79.5678).value());
  // Where the anchor, the middle of the tower's floor, comes to stand.
  const ModelTransform to_earth = placementTransform(placement, database.value().models()[0].tree().anchor,
                                                     database.value().area().grids[0].ellipsoid);
  const GeodeticPoint floor =
      toGeodetic(database.value().area().grids[0].ellipsoid, transformPoint(to_earth, {0, 0, 0}));
  EXPECT_NEAR(floor.latitude, 43.4321, 1e-9);
  EXPECT_NEAR(floor.longitude, -79.5678, 1e-9);
  EXPECT_NEAR(floor.height, placement.height, 1e-6);
}

TEST(PlaceModels, altitudes_count_from_the_datum_or_from_the_ground) {
  const MemoryFileSystem files = withModel();
  PlacementRequest absolute = at(43.5, -79.5), above = at(43.5, -79.5);
  absolute.altitude = 321;
  above.altitude = 12;
  above.above_ground = true;
  const std::vector<Placement> placed = put(files, {absolute, above}).value();
  const Database database = Database::open(files, kMemoryDatabasePath).value();
  EXPECT_FALSE(placed[0].on_ground);
  EXPECT_EQ(placed[0].height, 321);
  EXPECT_TRUE(placed[1].on_ground);
  EXPECT_EQ(placed[1].above_ground, 12);
  EXPECT_EQ(placed[1].height, *groundHeight(database, 43.5, -79.5).value() + 12);
}

TEST(PlaceModels, longitudes_and_headings_are_brought_into_one_turn) {
  const MemoryFileSystem files = withModel();
  PlacementRequest request = at(43.5, 280.5);
  request.heading = -90;
  const Placement placement = put(files, {request}).value().front();
  EXPECT_EQ(placement.longitude, -79.5);
  EXPECT_EQ(placement.heading, 270);
}

TEST(PlaceModels, one_place_without_ground_changes_nothing) {
  const MemoryFileSystem files = withModel();
  const std::string before = files.text(kMemoryDatabasePath + "/area.json");
  PlacementRequest outside = at(10, 10);
  outside.where = "towers.csv, line 2";
  const Result<std::vector<Placement>> placed = put(files, {at(43.5, -79.5), outside});
  ASSERT_FALSE(placed.ok());
  EXPECT_EQ(placed.error().kind, ErrorKind::kUsage);
  EXPECT_EQ(placed.error().where, "towers.csv, line 2");
  EXPECT_EQ(files.text(kMemoryDatabasePath + "/area.json"), before);
}

TEST(PlaceModels, a_void_is_no_ground) {
  SyntheticGridOptions options;
  options.voids = VoidPattern::kHole;
  const MemoryFileSystem files = buildInMemory(syntheticGrid(options));
  addFixtureModel(files, kMemoryDatabasePath);
  EXPECT_FALSE(put(files, {at(43.5, -79.5)}).ok());
  PlacementRequest absolute = at(43.5, -79.5);
  absolute.altitude = 100;
  EXPECT_TRUE(put(files, {absolute}).ok());
}

TEST(PlaceModels, numbers_are_never_given_twice) {
  const MemoryFileSystem files = withModel();
  ASSERT_TRUE(put(files, {at(43.5, -79.5), at(43.6, -79.5)}).ok());
  ASSERT_TRUE(removePlacement(files, kMemoryDatabasePath, kFixtureModelName, 2).ok());
  ASSERT_TRUE(removePlacement(files, kMemoryDatabasePath, kFixtureModelName, 1).ok());
  EXPECT_FALSE(removePlacement(files, kMemoryDatabasePath, kFixtureModelName, 1).ok());
  EXPECT_EQ(put(files, {at(43.5, -79.5)}).value().front().instance, 3u);
}

TEST(PlaceModels, pages_hold_what_stands_together_and_their_spheres_hold_it_all) {
  const MemoryFileSystem files = withModel();
  std::vector<PlacementRequest> requests;
  for (int k = 0; k < 500; ++k)
    requests.push_back(at(43.05 + 0.0017 * (k * 37 % 500), -79.95 + 0.0017 * (k * 91 % 500)));
  ASSERT_TRUE(put(files, requests).ok());
  const Database database = Database::open(files, kMemoryDatabasePath).value();
  const PlacementSet& set = *database.placements();
  ASSERT_EQ(set.directory().pages.size(), 8u);
  const ModelTree& tree = database.models()[0].tree();
  std::size_t count = 0;
  double sum = 0;
  for (std::uint32_t page = 0; page < 8; ++page) {
    const PlacementSphere& sphere = set.directory().pages[page];
    sum += sphere.radius;
    for (const Placement& placement : set.page(page).value()) {
      ++count;
      const ModelTransform to_earth =
          placementTransform(placement, tree.anchor, database.area().grids[0].ellipsoid);
      for (const ModelPart& part : tree.parts) {
        const ModelTransform part_to_earth = concatenate(
            part.parent == kNoParent ? part.transform
                                     : concatenate(part.transform, tree.parts[part.parent].transform),
            to_earth);
        for (const ModelLod& lod : part.lods) {
          const ModelMesh mesh = database.models()[0].mesh(lod).value();
          for (const auto& [x, y, z] : mesh.vertices) {
            const Vector3 p = transformPoint(
                part_to_earth, {static_cast<double>(x), static_cast<double>(y), static_cast<double>(z)});
            EXPECT_LE(length(p - Vector3{sphere.centre[0], sphere.centre[1], sphere.centre[2]}),
                      sphere.radius);
          }
        }
      }
    }
  }
  EXPECT_EQ(count, 500u);
  const std::vector<Placement> all = set.all().value();
  const std::vector<ModelTree> trees = {tree};
  const double whole = placementSphere(all, trees, database.area().grids[0].ellipsoid).radius;
  // Pages of places in any order would be as large as the whole; a few straddle a jump of the curve.
  EXPECT_LT(sum / 8, 0.6 * whole);
}

TEST(PlaceModels, a_model_that_is_not_there_is_named) {
  const MemoryFileSystem files = withModel();
  const auto placed =
      placeModels(files, kMemoryDatabasePath, "mill", std::vector<PlacementRequest>{at(43.5, -79.5)});
  ASSERT_FALSE(placed.ok());
  EXPECT_NE(placed.error().message().find("mill"), std::string::npos);
  EXPECT_NE(placed.error().message().find(kFixtureModelName), std::string::npos);
}

}  // namespace
}  // namespace deltaz
