#include <gtest/gtest.h>

#include "libdb/access/database.h"
#include "tests/support/model_fixture.h"
#include "tests/support/synthetic_grid.h"

namespace deltaz {
namespace {

TEST(ModelWriter, what_is_put_in_comes_back) {
  const MemoryFileSystem files = buildInMemory(syntheticGrid());
  addFixtureModel(files, kMemoryDatabasePath);
  const Result<Database> database = Database::open(files, kMemoryDatabasePath);
  ASSERT_TRUE(database.ok()) << database.error().message();
  ASSERT_EQ(database.value().models().size(), 1u);
  const Model& model = database.value().models().front();
  const FinishedModel expected = fixtureModel();
  EXPECT_EQ(model.tree(), modelTreeOf(expected));
  for (std::size_t p = 0; p < expected.parts.size(); ++p) {
    for (std::size_t k = 0; k < expected.parts[p].lods.size(); ++k) {
      EXPECT_EQ(model.mesh(model.tree().parts[p].lods[k]).value(), expected.parts[p].lods[k].mesh);
      EXPECT_EQ(model.tree().parts[p].lods[k].error, expected.parts[p].lods[k].error);
    }
  }
}

TEST(ModelWriter, spheres_hold_every_vertex) {
  const FinishedModel model = fixtureModel();
  const ModelTree tree = modelTreeOf(model);
  for (std::size_t p = 0; p < model.parts.size(); ++p) {
    for (const FinishedLod& lod : model.parts[p].lods) {
      for (const auto& [x, y, z] : lod.mesh.vertices) {
        const ModelPart& part = tree.parts[p];
        const Vector3 at{static_cast<double>(x), static_cast<double>(y), static_cast<double>(z)};
        EXPECT_LE(length(at - Vector3{part.centre[0], part.centre[1], part.centre[2]}), part.radius);
        const Vector3 in_model = transformPoint(part.transform, at);
        EXPECT_LE(length(in_model - Vector3{tree.centre[0], tree.centre[1], tree.centre[2]}), tree.radius);
      }
    }
  }
}

TEST(ModelWriter, replacing_a_model_keeps_the_others_and_renews_the_spheres_of_pages) {
  const MemoryFileSystem files = buildInMemory(syntheticGrid());
  addFixtureModel(files, kMemoryDatabasePath, "first");
  addFixtureModel(files, kMemoryDatabasePath, "second");
  setPlacements(files, kMemoryDatabasePath, {placementAt(43.5, -79.5, 100)});
  const double before =
      Database::open(files, kMemoryDatabasePath).value().placements()->directory().pages.front().radius;
  FinishedModel wide = fixtureModel();
  wide.parts[0].lods[0].mesh.vertices[0] = {-500, 0, 0};
  const AssetHeader header{"first", "mesh", {}, {}};
  const Status refused = putModel(files, kMemoryDatabasePath, header, wide, false);
  ASSERT_FALSE(refused.ok());
  EXPECT_EQ(refused.error().kind, ErrorKind::kUsage);
  ASSERT_TRUE(putModel(files, kMemoryDatabasePath, header, wide, true).ok());
  const Result<Database> database = Database::open(files, kMemoryDatabasePath);
  ASSERT_TRUE(database.ok()) << database.error().message();
  EXPECT_EQ(database.value().models()[0].tree(), modelTreeOf(wide));
  EXPECT_EQ(database.value().models()[1].tree(), modelTreeOf(fixtureModel()));
  EXPECT_GT(database.value().placements()->directory().pages.front().radius, before + 200);
}

TEST(ModelWriter, a_model_that_stands_somewhere_is_not_removed) {
  const MemoryFileSystem files = buildInMemory(syntheticGrid());
  addFixtureModel(files, kMemoryDatabasePath);
  setPlacements(files, kMemoryDatabasePath, {placementAt(43.5, -79.5, 100)});
  const Status status = removeModel(files, kMemoryDatabasePath, kFixtureModelName);
  ASSERT_FALSE(status.ok());
  EXPECT_EQ(status.error().kind, ErrorKind::kUsage);
}

TEST(ModelWriter, placements_follow_their_model_when_an_earlier_one_is_removed) {
  const MemoryFileSystem files = buildInMemory(syntheticGrid());
  addFixtureModel(files, kMemoryDatabasePath, "first");
  addFixtureModel(files, kMemoryDatabasePath, "second");
  Placement placement = placementAt(43.5, -79.5, 100);
  placement.model = 1;
  setPlacements(files, kMemoryDatabasePath, {placement});
  ASSERT_TRUE(removeModel(files, kMemoryDatabasePath, "first").ok());
  const Result<Database> database = Database::open(files, kMemoryDatabasePath);
  ASSERT_TRUE(database.ok()) << database.error().message();
  ASSERT_EQ(database.value().area().models.size(), 1u);
  EXPECT_EQ(database.value().area().models.front().name, "second");
  const std::vector<Placement> all = database.value().placements()->all().value();
  ASSERT_EQ(all.size(), 1u);
  EXPECT_EQ(all.front().model, 0u);
  EXPECT_EQ(all.front().instance, 1u);
}

TEST(ModelWriter, removing_the_last_model_keeps_the_numbers_given) {
  const MemoryFileSystem files = buildInMemory(syntheticGrid());
  addFixtureModel(files, kMemoryDatabasePath);
  setPlacements(files, kMemoryDatabasePath, {});
  ASSERT_TRUE(removeModel(files, kMemoryDatabasePath, kFixtureModelName).ok());
  const Result<Database> database = Database::open(files, kMemoryDatabasePath);
  ASSERT_TRUE(database.ok()) << database.error().message();
  EXPECT_TRUE(database.value().models().empty());
  EXPECT_NE(database.value().placements(), nullptr);
}

}  // namespace
}  // namespace deltaz
