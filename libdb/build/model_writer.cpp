#include "libdb/build/model_writer.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <optional>

#include "formats/container.h"
#include "libdb/access/database.h"
#include "libdb/build/placement_writer.h"
#include "libdb/build/publication.h"

namespace deltaz {

namespace {

struct Sphere {
  std::array<double, 3> centre{};
  double radius = 0;
};

// Around the middle of the points' box; rounded outwards.
Sphere sphereAround(const std::vector<Vector3>& points) {
  Sphere sphere;
  if (points.empty()) return sphere;
  Vector3 low = points.front(), high = points.front();
  for (const Vector3& p : points) {
    low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
  }
  const Vector3 middle = (low + high) * 0.5;
  for (const Vector3& p : points) sphere.radius = std::max(sphere.radius, length(p - middle));
  sphere.centre = {middle.x, middle.y, middle.z};
  sphere.radius *= 1 + 1e-12;
  return sphere;
}

Result<FileIdentity> writeModelFile(const FileSystem& files, const std::string& path,
                                    const FinishedModel& model) {
  DELTAZ_TRY_ASSIGN(ContainerWriter writer, ContainerWriter::create(files, path, ContentKind::kModel));
  for (const FinishedPart& part : model.parts) {
    for (const FinishedLod& lod : part.lods) {
      const std::vector<std::byte> bytes = encodeModelMesh(lod.mesh);
      if (bytes.size() > kMaximumBlockBytes) {
        return invalidError(
            IssueCode::kNone, part.name, "the mesh does not fit into one block of a model file",
            fmt::format("it takes {} bytes, {} are the most", bytes.size(), kMaximumBlockBytes),
            "Split it into parts");
      }
      DELTAZ_TRY_ASSIGN([[maybe_unused]] const std::uint32_t block,
                        writer.append(BlockType::kModelMesh, bytes));
    }
  }
  DELTAZ_TRY_ASSIGN([[maybe_unused]] const std::uint32_t block,
                    writer.append(BlockType::kModelTree, encodeModelTree(modelTreeOf(model))));
  return writer.finish();
}

// What the edits below look at before they change anything: the database, and what stands in it.
struct PlacedModels {
  std::vector<ModelTree> trees;
  std::vector<Placement> placements;
  std::uint32_t next_instance = 1;
};

Result<PlacedModels> readPlacedModels(const FileSystem& files, const std::string& target) {
  DELTAZ_TRY_ASSIGN(const Database database, Database::open(files, target));
  PlacedModels placed;
  for (const Model& model : database.models()) placed.trees.push_back(model.tree());
  if (const PlacementSet* set = database.placements()) {
    placed.next_instance = set->directory().next_instance;
    DELTAZ_TRY_ASSIGN(placed.placements, set->all());
  }
  return placed;
}

std::optional<std::uint32_t> findModel(const AreaHeader& area, const std::string& name) {
  for (std::size_t k = 0; k < area.models.size(); ++k) {
    if (area.models[k].name == name) return static_cast<std::uint32_t>(k);
  }
  return std::nullopt;
}

Status checkName(const std::string& name) {
  if (isAssetName(name)) return Success{};
  return usageError(name, "this cannot name a model", "names are 1 to 64 of A-Z a-z 0-9 _ - and dots within",
                    "Choose another name");
}

Status checkFree(const AreaHeader& area, const std::string& name, bool overwrite) {
  if (overwrite || !findModel(area, name)) return Success{};
  return usageError(name, "the database has a model of this name", {},
                    "Choose another name or give --overwrite");
}

// Where a reference to model `number` belongs: models are listed in their order.
std::vector<FileReference>::iterator placeOfModel(AreaHeader& area, std::uint32_t number) {
  return std::find_if(area.files.begin(), area.files.end(), [&](const FileReference& file) {
    return file.role == FileRole::kModel && file.segment > number;
  });
}

}  // namespace

ModelTree modelTreeOf(const FinishedModel& model) {
  ModelTree tree;
  tree.anchor = model.anchor;
  std::vector<ModelTransform> to_model;
  std::vector<Vector3> all;
  std::uint32_t block = 0;
  for (const FinishedPart& source : model.parts) {
    ModelPart part;
    part.name = source.name;
    part.parent = source.parent;
    part.transform = source.transform;
    to_model.push_back(source.parent == kNoParent ? source.transform
                                                  : concatenate(source.transform, to_model[source.parent]));
    std::vector<Vector3> own;
    for (const FinishedLod& lod : source.lods) {
      part.lods.push_back({block++, static_cast<std::uint32_t>(lod.mesh.triangles.size()), lod.error});
      for (const auto& [x, y, z] : lod.mesh.vertices) {
        own.push_back({static_cast<double>(x), static_cast<double>(y), static_cast<double>(z)});
        all.push_back(transformPoint(to_model.back(), own.back()));
      }
    }
    const Sphere sphere = sphereAround(own);
    part.centre = sphere.centre;
    part.radius = sphere.radius;
    tree.parts.push_back(std::move(part));
  }
  const Sphere sphere = sphereAround(all);
  tree.centre = sphere.centre;
  tree.radius = sphere.radius;
  return tree;
}

Status checkModelTarget(const FileSystem& files, const std::string& target, const std::string& name,
                        bool overwrite) {
  DELTAZ_TRY(checkName(name));
  DELTAZ_TRY_ASSIGN(const Database database, Database::open(files, target));
  return checkFree(database.area(), name, overwrite);
}

Status putModel(const FileSystem& files, const std::string& target, const AssetHeader& header,
                const FinishedModel& model, bool overwrite) {
  DELTAZ_TRY(checkName(header.name));
  DELTAZ_TRY_ASSIGN(Publication publication, Publication::beginEdit(files, target));
  AreaHeader area = publication.area();
  DELTAZ_TRY(checkFree(area, header.name, overwrite));
  const std::optional<std::uint32_t> existing = findModel(area, header.name);
  DELTAZ_TRY_ASSIGN(PlacedModels placed, readPlacedModels(files, target));
  const ModelTree tree = modelTreeOf(model);
  // Nothing is published that a reader would refuse.
  const std::vector<std::byte> bytes = encodeModelTree(tree);
  if (const Result<ModelTree> back = decodeModelTree(bytes, kNoParent, header.name); !back.ok())
    return back.error();
  const auto number = existing.value_or(static_cast<std::uint32_t>(area.models.size()));
  const std::string name = fmt::format("model-{:06}-{:03}.dzm", publication.generation(), number);
  DELTAZ_TRY_ASSIGN(const FileIdentity identity, writeModelFile(files, publication.newFilePath(name), model));
  const FileReference reference{FileRole::kModel, number, name, identity.length, identity.id};
  if (existing) {
    area.models[number] = header;
    placed.trees[number] = tree;
    std::erase_if(area.files, [&](const FileReference& file) {
      return file.role == FileRole::kModel && file.segment == number;
    });
  } else {
    area.models.push_back(header);
    placed.trees.push_back(tree);
  }
  area.files.insert(placeOfModel(area, number), reference);
  const bool stands = std::any_of(placed.placements.begin(), placed.placements.end(),
                                  [&](const Placement& placement) { return placement.model == number; });
  if (stands) {
    DELTAZ_TRY(
        writePlacements(files, publication, area, placed.placements, placed.next_instance, placed.trees));
  }
  return publication.publish(area);
}

Status removeModel(const FileSystem& files, const std::string& target, const std::string& name) {
  DELTAZ_TRY_ASSIGN(Publication publication, Publication::beginEdit(files, target));
  AreaHeader area = publication.area();
  const std::optional<std::uint32_t> number = findModel(area, name);
  if (!number) return usageError(name, "the database has no model of this name");
  DELTAZ_TRY_ASSIGN(PlacedModels placed, readPlacedModels(files, target));
  const auto standing = std::count_if(placed.placements.begin(), placed.placements.end(),
                                      [&](const Placement& placement) { return placement.model == *number; });
  if (standing > 0) {
    return usageError(name, "the model cannot be removed",
                      fmt::format("it still stands at {} place{}", standing, standing == 1 ? "" : "s"),
                      "Remove its placements first with 'dbbuild place --remove'");
  }
  area.models.erase(area.models.begin() + *number);
  placed.trees.erase(placed.trees.begin() + *number);
  std::erase_if(area.files, [&](const FileReference& file) {
    return file.role == FileRole::kModel && file.segment == *number;
  });
  for (FileReference& file : area.files) {
    if (file.role == FileRole::kModel && file.segment > *number) --file.segment;
  }
  bool renumbered = false;
  for (Placement& placement : placed.placements) {
    if (placement.model > *number) {
      --placement.model;
      renumbered = true;
    }
  }
  if (renumbered) {
    DELTAZ_TRY(
        writePlacements(files, publication, area, placed.placements, placed.next_instance, placed.trees));
  }
  return publication.publish(area);
}

}  // namespace deltaz
