#include "libdb/build/build_model.h"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <gtest/gtest.h>

#include "libdb/access/database.h"
#include "tests/support/model_fixture.h"
#include "tests/support/sampled_distance.h"
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

struct Soup {
  std::vector<Vector3> positions;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  TriangleView view() const { return {positions, triangles}; }
};

Soup soupOf(const ModelMesh& mesh) {
  Soup soup;
  for (const auto& [x, y, z] : mesh.vertices)
    soup.positions.push_back({static_cast<double>(x), static_cast<double>(y), static_cast<double>(z)});
  soup.triangles = mesh.triangles;
  return soup;
}

// More samples where triangles are few.
int stepsFor(const Soup& soup) {
  return soup.triangles.size() > 1000 ? 2 : soup.triangles.size() > 300 ? 5 : 14;
}

const std::string kSampleMeshes = std::string(DELTAZ_SAMPLES) + "/models";

// The samples', and those of DELTAZ_TEST_DATA where it names a folder.
std::vector<std::string> realMeshes() {
  std::vector<std::string> folders = {kSampleMeshes};
  if (const char* const more = std::getenv("DELTAZ_TEST_DATA"); more != nullptr && *more != '\0')
    folders.push_back(std::string(more) + "/mesh");
  std::vector<std::string> meshes;
  for (const std::string& folder : folders) {
    for (const auto& entry : std::filesystem::directory_iterator(folder)) {
      const std::string ending = entry.path().extension().string();
      // The engine has too many triangles to be tried one by one.
      const bool small = entry.file_size() < 1000000;
      if (small && (ending == ".glb" || ending == ".ply" || ending == ".stl"))
        meshes.push_back(entry.path().string());
    }
  }
  return meshes;
}

TEST(BuildModel, stored_errors_of_real_meshes_hold_against_samples) {
  const std::vector<std::string> meshes = realMeshes();
  ASSERT_GE(meshes.size(), 4u);
  const MemoryFileSystem files = buildInMemory(syntheticGrid());
  std::size_t compared = 0;
  for (const std::string& mesh : meshes) {
    ModelBuildOptions options;
    options.name = "model";
    options.overwrite = true;
    const Result<ModelSummary> summary = buildModel(files, kMemoryDatabasePath, {mesh}, options);
    ASSERT_TRUE(summary.ok()) << summary.error().message();
    const Result<Database> database = Database::open(files, kMemoryDatabasePath);
    ASSERT_TRUE(database.ok());
    const Model& model = database.value().models().front();
    for (const ModelPart& part : model.tree().parts) {
      if (part.lods.empty()) continue;
      const Soup finest = soupOf(model.mesh(part.lods.front()).value());
      for (std::size_t k = 1; k < part.lods.size(); ++k) {
        EXPECT_LT(part.lods[k].triangle_count, part.lods[k - 1].triangle_count);
        EXPECT_GT(part.lods[k].error, part.lods[k - 1].error);
        const Soup coarse = soupOf(model.mesh(part.lods[k]).value());
        const double sampled = std::max(sampledDistance(finest.view(), coarse.view(), stepsFor(finest)),
                                        sampledDistance(coarse.view(), finest.view(), stepsFor(coarse)));
        const double stored = static_cast<double>(part.lods[k].error);
        EXPECT_GE(stored, sampled) << mesh << ", level " << k;
        EXPECT_LE(stored, 1.2 * sampled) << mesh << ", level " << k;
        ++compared;
      }
    }
  }
  EXPECT_GE(compared, meshes.size());
}

TEST(BuildModel, the_bytes_do_not_depend_on_the_number_of_threads) {
  const std::vector<std::string> meshes = {kSampleMeshes + "/house-4-2.glb",
                                           kSampleMeshes + "/tree-spruce-0-0.glb"};
  std::vector<MemoryFileSystem> results;
  for (const int threads : {1, 2}) {
    const MemoryFileSystem files = buildInMemory(syntheticGrid());
    ModelBuildOptions options;
    options.name = "village";
    options.threads = threads;
    const Result<ModelSummary> summary = buildModel(files, kMemoryDatabasePath, meshes, options);
    ASSERT_TRUE(summary.ok()) << summary.error().message();
    EXPECT_EQ(summary.value().parts.size(), 3u);
    results.push_back(files);
  }
  ASSERT_EQ(results[0].paths(), results[1].paths());
  for (const std::string& path : results[0].paths())
    EXPECT_EQ(results[0].bytes(path), results[1].bytes(path));
}

}  // namespace
}  // namespace deltaz
