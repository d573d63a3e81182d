// Models and placements that contradict themselves or the ground.
#include <cmath>
#include <gtest/gtest.h>

#include "libdb/access/ground_query.h"
#include "tests/libdb/check/code_assets.h"
#include "tests/support/asset_editor.h"
#include "tests/support/model_fixture.h"

namespace deltaz {

namespace {

// Two towers that follow the ground and one that does not.
const MemoryFileSystem& placedDatabase() {
  static const MemoryFileSystem files = [] {
    MemoryFileSystem made = soundDatabase();
    addFixtureModel(made, kMemoryDatabasePath);
    const Database database = Database::open(made, kMemoryDatabasePath).value();
    std::vector<Placement> placements;
    for (const auto& [latitude, longitude] : {std::pair(43.1, -79.9), {43.2, -79.7}, {43.3, -79.8}}) {
      const double ground = groundHeight(database, latitude, longitude).value().value();
      placements.push_back(placementAt(latitude, longitude, ground, 30));
    }
    placements[0].on_ground = placements[1].on_ground = true;
    placements[1].above_ground = 12;
    placements[1].height += 12;
    placements[2].height += 500;
    setPlacements(made, kMemoryDatabasePath, placements);
    return made;
  }();
  return files;
}

Recipe withModel(const std::function<void(ModelParts&)>& change, CheckLevel level = CheckLevel::kDecode) {
  return [change, level](const MemoryFileSystem&) {
    MemoryFileSystem files = placedDatabase();
    changeModel(files, change);
    return checkedAt(files, level);
  };
}

Recipe withPlacements(const std::function<void(PlacementParts&)>& change) {
  return [change](const MemoryFileSystem&) {
    MemoryFileSystem files = placedDatabase();
    changePlacements(files, change);
    return checkedAt(files, CheckLevel::kDecode);
  };
}

// Scales what part 1 is made of, in its own space, along its three axes.
void scaleHead(ModelParts& parts, double x, double y, double z) {
  ModelTransform& m = parts.tree.parts.at(1).transform;
  for (std::size_t k = 0; k < 3; ++k) {
    m[k] *= x;
    m[3 + k] *= y;
    m[6 + k] *= z;
  }
}

Placement& onGround(PlacementParts& parts) {
  for (auto& page : parts.pages) {
    for (Placement& placement : page) {
      if (placement.on_ground) return placement;
    }
  }
  throw std::runtime_error("nothing follows the ground");
}

}  // namespace

std::vector<Asset> modelAssets() {
  return {
      {IssueCode::kModelTree,
       withModel([](ModelParts& parts) { parts.tree.parts.at(1).name = parts.tree.parts.at(0).name; }),
       // Meshes may stand in any order.
       withModel([](ModelParts& parts) {
         std::swap(parts.meshes.at(0), parts.meshes.at(1));
         std::swap(parts.tree.parts.at(0).lods.at(0).block, parts.tree.parts.at(0).lods.at(1).block);
       })},
      {IssueCode::kModelMesh,
       withModel([](ModelParts& parts) { parts.tree.parts.at(0).lods.at(1).triangle_count += 1; }),
       withModel([](ModelParts& parts) {
         auto& triangle = parts.meshes.at(0).triangles.at(0);
         triangle = {triangle[1], triangle[2], triangle[0]};
       })},
      {IssueCode::kModelSphere, withModel([](ModelParts& parts) { parts.tree.parts.at(0).radius -= 0.01; }),
       withModel([](ModelParts& parts) { parts.tree.parts.at(0).radius += 0.01; })},
      {IssueCode::kModelError,
       withModel([](ModelParts& parts) { parts.tree.parts.at(0).lods.at(1).error *= 0.99f; },
                 CheckLevel::kGeometry),
       withModel([](ModelParts& parts) { parts.tree.parts.at(0).lods.at(1).error *= 1.15f; },
                 CheckLevel::kGeometry)},
      {IssueCode::kModelLod,
       withModel([](ModelParts& parts) { parts.tree.parts.at(0).lods.at(0).error = 0.01f; }),
       // A coarser level that is the finest again.
       withModel([](ModelParts& parts) {
         parts.meshes.at(1) = parts.meshes.at(0);
         parts.tree.parts.at(0).lods.at(1).triangle_count = parts.tree.parts.at(0).lods.at(0).triangle_count;
         parts.tree.parts.at(0).lods.at(1).error = 0;
       })},
      {IssueCode::kModelTransform, withModel([](ModelParts& parts) { scaleHead(parts, 0.99, 1, 1); }),
       withModel([](ModelParts& parts) { scaleHead(parts, 0.99, 0.99, 0.99); })},
      {IssueCode::kPlacementRecord, withPlacements([](PlacementParts& parts) {
         parts.pages.at(0).at(0).instance = parts.pages.at(0).at(1).instance;
       }),
       // Numbers of what was taken away again leave gaps.
       withPlacements([](PlacementParts& parts) {
         parts.directory.next_instance = 1000;
         parts.pages.at(0).at(0).instance = 999;
       })},
      {IssueCode::kPlacementSphere,
       withPlacements([](PlacementParts& parts) { parts.directory.pages.at(0).radius *= 0.9; }),
       withPlacements([](PlacementParts& parts) { parts.directory.pages.at(0).radius *= 1.1; })},
      {IssueCode::kPlacementGround,
       withPlacements([](PlacementParts& parts) { onGround(parts).height += 0.02; }),
       withPlacements([](PlacementParts& parts) { onGround(parts).height -= 0.005; })},
  };
}

}  // namespace deltaz
