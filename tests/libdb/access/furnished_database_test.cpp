// A database with colour maps, models and placements: that each file is the one its header means.
#include <gtest/gtest.h>

#include "libdb/access/content_digest.h"
#include "libdb/access/database.h"
#include "tests/support/asset_editor.h"
#include "tests/support/furnished_area.h"
#include "tests/support/model_fixture.h"
#include "tests/support/synthetic_grid.h"

namespace deltaz {
namespace {

IssueCode openingFails(const MemoryFileSystem& files) {
  const Result<Database> database = Database::open(files, kMemoryDatabasePath);
  return database.ok() ? IssueCode::kNone : database.error().code;
}

FileReference& listed(AreaHeader& area, FileRole role) {
  for (FileReference& file : area.files) {
    if (file.role == role) return file;
  }
  throw std::runtime_error("no such file");
}

TEST(FurnishedDatabase, hands_out_what_was_put_in) {
  const Database database = Database::open(furnishedArea(), kMemoryDatabasePath).value();
  ASSERT_EQ(database.colorMaps().size(), 1u);
  ASSERT_EQ(database.models().size(), 1u);
  EXPECT_EQ(database.findModel(kFixtureModelName), 0u);
  EXPECT_FALSE(database.findModel("bridge").has_value());
  const FinishedModel put = fixtureModel();
  const Model& model = database.models()[0];
  ASSERT_EQ(model.tree().parts.size(), put.parts.size());
  for (std::size_t part = 0; part < put.parts.size(); ++part) {
    ASSERT_EQ(model.tree().parts[part].lods.size(), put.parts[part].lods.size());
    for (std::size_t lod = 0; lod < put.parts[part].lods.size(); ++lod) {
      const auto mesh = model.mesh(model.tree().parts[part].lods[lod]);
      ASSERT_TRUE(mesh.ok()) << mesh.error().message();
      EXPECT_EQ(mesh.value(), put.parts[part].lods[lod].mesh);
    }
  }
  ASSERT_NE(database.placements(), nullptr);
  const auto placements = database.placements()->all();
  ASSERT_TRUE(placements.ok()) << placements.error().message();
  EXPECT_EQ(placements.value().size(), 3u);
  EXPECT_EQ(database.placements()->directory().next_instance, 4u);
}

TEST(FurnishedDatabase, has_the_digest_of_its_terrain) {
  BuildOptions options;
  options.leaf_cells = 8;
  const MemoryFileSystem plain = buildInMemory(furnishedGrid(), options);
  const auto digest = [](const MemoryFileSystem& files) {
    return contentDigest(Database::open(files, kMemoryDatabasePath).value()).value();
  };
  const Hash128 of_terrain = digest(plain);
  EXPECT_EQ(digest(furnishedArea()), of_terrain);
  MemoryFileSystem bare = furnishedArea();
  AreaHeader area = areaOf(bare);
  area.color_maps.clear();
  std::erase_if(area.files, [](const FileReference& file) { return file.role == FileRole::kColors; });
  setArea(bare, area);
  EXPECT_EQ(digest(bare), of_terrain);
}

TEST(FurnishedDatabase, a_missing_or_exchanged_file_is_found_on_opening) {
  for (const FileRole role : {FileRole::kColors, FileRole::kModel, FileRole::kPlacements}) {
    MemoryFileSystem missing = furnishedArea();
    ASSERT_TRUE(missing.removeFile(assetPath(missing, role)).ok());
    EXPECT_EQ(openingFails(missing), IssueCode::kIoMissingFile);
    MemoryFileSystem exchanged = furnishedArea();
    changeAsset(exchanged, role, 0,
                [](std::vector<AssetBlock>& blocks) { blocks.front().payload.back() ^= std::byte{1}; });
    setArea(exchanged, areaOf(furnishedArea()));
    EXPECT_EQ(openingFails(exchanged), IssueCode::kManFileMismatch);
  }
}

TEST(FurnishedDatabase, files_are_listed_in_the_order_of_their_headers_and_each_once) {
  const auto fails = [](const std::function<void(AreaHeader&)>& change) {
    MemoryFileSystem files = furnishedArea();
    AreaHeader area = areaOf(files);
    change(area);
    setArea(files, area);
    return openingFails(files);
  };
  EXPECT_EQ(fails([](auto&) {}), IssueCode::kNone);
  for (const FileRole role : {FileRole::kColors, FileRole::kModel, FileRole::kPlacements}) {
    EXPECT_EQ(fails([&](auto& area) { listed(area, role).segment = 1; }), IssueCode::kManField);
    EXPECT_EQ(fails([&](auto& area) { area.files.push_back(listed(area, role)); }), IssueCode::kManField);
  }
  EXPECT_EQ(fails([](auto& area) {
              area.color_maps.push_back({"winter", "image", {}, {}});
            }),
            IssueCode::kManField);
  EXPECT_EQ(fails([](auto& area) {
              area.models.push_back({"bridge", "mesh", {}, {}});
            }),
            IssueCode::kManField);
  EXPECT_EQ(fails([](auto& area) { area.color_maps.clear(); }), IssueCode::kManField);
  EXPECT_EQ(fails([](auto& area) {
              std::erase_if(area.files, [](const auto& file) { return file.role == FileRole::kModel; });
            }),
            IssueCode::kManField);
}

TEST(FurnishedDatabase, a_file_of_another_kind_is_refused) {
  MemoryFileSystem files = furnishedArea();
  AreaHeader area = areaOf(files);
  std::swap(listed(area, FileRole::kColors).role, listed(area, FileRole::kModel).role);
  setArea(files, area);
  EXPECT_NE(openingFails(files), IssueCode::kNone);
}

TEST(FurnishedDatabase, a_mesh_with_other_triangles_than_announced_is_refused) {
  MemoryFileSystem files = furnishedArea();
  changeModel(files, [](ModelParts& parts) { parts.tree.parts[0].lods[0].triangle_count += 1; });
  const Database database = Database::open(files, kMemoryDatabasePath).value();
  const Model& model = database.models()[0];
  EXPECT_EQ(model.mesh(model.tree().parts[0].lods[0]).error().code, IssueCode::kModelMesh);
  EXPECT_TRUE(model.mesh(model.tree().parts[0].lods[1]).ok());
}

TEST(FurnishedDatabase, placements_with_numbers_not_given_are_refused) {
  MemoryFileSystem files = furnishedArea();
  changePlacements(files, [](PlacementParts& parts) { parts.pages[0][1].instance = 4; });
  const Database database = Database::open(files, kMemoryDatabasePath).value();
  EXPECT_EQ(database.placements()->page(0).error().code, IssueCode::kPlacementRecord);
  EXPECT_FALSE(database.placements()->page(1).ok());
}

}  // namespace
}  // namespace deltaz
