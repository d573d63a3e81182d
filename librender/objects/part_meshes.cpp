#include "librender/objects/part_meshes.h"

#include <map>
#include <optional>
#include <tbb/parallel_for.h>
#include <utility>

namespace deltaz {

Result<PartMeshes> PartMeshes::read(const Database& database, const std::vector<DrawnPart>& parts) {
  PartMeshes table;
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::size_t> places;  // by model and block
  std::vector<std::pair<const Model*, const ModelLod*>> wanted;
  for (const DrawnPart& drawn : parts) {
    const Model& model = database.models()[drawn.model];
    const ModelLod& lod = model.tree().parts[drawn.part].lods[drawn.lod];
    const auto [place, added] = places.emplace(std::pair(drawn.model, lod.block), wanted.size());
    if (added) wanted.emplace_back(&model, &lod);
    table.index_.push_back(place->second);
  }
  std::vector<std::optional<Result<ModelMesh>>> read(wanted.size());
  tbb::parallel_for(std::size_t{0}, wanted.size(),
                    [&](std::size_t m) { read[m].emplace(wanted[m].first->mesh(*wanted[m].second)); });
  for (std::optional<Result<ModelMesh>>& mesh : read) {
    if (!mesh->ok()) return mesh->error();
    table.meshes_.push_back(std::move(*mesh).value());
  }
  return table;
}

}  // namespace deltaz
