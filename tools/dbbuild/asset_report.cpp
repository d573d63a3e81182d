#include "tools/dbbuild/asset_report.h"

#include <fmt/format.h>

namespace deltaz {

namespace {

Json assetsJson(const std::vector<AssetHeader>& assets) {
  Json list = Json::array();
  for (const AssetHeader& asset : assets) {
    Json json;
    json["name"] = asset.name;
    json["origin"] = asset.origin;
    json["sources"] = Json::array();
    for (const SourceFile& source : asset.sources)
      json["sources"].push_back({{"name", source.name}, {"content", toHex(source.content)}});
    json["options"] = Json::object();
    for (const auto& [name, value] : asset.options) json["options"][name] = value;
    list.push_back(json);
  }
  return list;
}

Json partJson(const ModelTree& tree, const ModelPart& part) {
  Json json;
  json["name"] = part.name;
  json["parent"] = part.parent == kNoParent ? Json(nullptr) : Json(tree.parts[part.parent].name);
  json["radius"] = part.radius;
  json["lods"] = Json::array();
  for (const ModelLod& lod : part.lods)
    json["lods"].push_back({{"triangles", lod.triangle_count}, {"error_metres", lod.error}});
  return json;
}

// How many models stand in the area.
std::uint32_t placementCount(const Database& database) {
  return database.placements() == nullptr ? 0 : database.placements()->directory().count;
}

std::string sourcesText(const AssetHeader& asset) {
  std::string names;
  for (const SourceFile& source : asset.sources) names += (names.empty() ? "" : ", ") + source.name;
  return names.empty() ? std::string() : " of " + names;
}

std::string partText(const ModelPart& part) {
  std::string text = fmt::format("    part          {}", part.name);
  for (std::size_t k = 0; k < part.lods.size(); ++k) {
    const std::uint64_t count = part.lods[k].triangle_count;
    text += fmt::format("{} {} triangle{}", k == 0 ? ":" : ",", count, count == 1 ? "" : "s");
    if (k > 0) text += fmt::format(" within {:.3g} m", part.lods[k].error);
  }
  return text + "\n";
}

}  // namespace

Json colorMapsJson(const Database& database) {
  Json list = assetsJson(database.area().color_maps);
  for (std::size_t k = 0; k < list.size(); ++k) {
    const ColorDirectory& directory = database.colorMaps()[k].directory();
    list[k]["nodes"] = directory.node_count;
    list[k]["trees"] = Json::array();
    for (const ColorTree& tree : directory.trees) {
      list[k]["trees"].push_back({{"grid", tree.grid},
                                  {"finest_level", tree.finest_level},
                                  {"coarsest_level", tree.coarsest_level}});
    }
  }
  return list;
}

Json modelsJson(const Database& database) {
  Json list = assetsJson(database.area().models);
  for (std::size_t k = 0; k < list.size(); ++k) {
    const ModelTree& tree = database.models()[k].tree();
    list[k]["anchor"] = tree.anchor;
    list[k]["centre"] = tree.centre;
    list[k]["radius"] = tree.radius;
    list[k]["parts"] = Json::array();
    for (const ModelPart& part : tree.parts) list[k]["parts"].push_back(partJson(tree, part));
  }
  return list;
}

Result<Json> placementsJson(const Database& database) {
  Json list = Json::array();
  if (database.placements() == nullptr) return list;
  DELTAZ_TRY_ASSIGN(const std::vector<Placement> placements, database.placements()->all());
  for (const Placement& placement : placements) {
    list.push_back({{"instance", placement.instance},
                    {"model", database.area().models[placement.model].name},
                    {"latitude", placement.latitude},
                    {"longitude", placement.longitude},
                    {"height", placement.height},
                    {"heading", placement.heading},
                    {"on_ground", placement.on_ground},
                    {"above_ground", placement.above_ground}});
  }
  return list;
}

std::string assetsText(const Database& database, bool verbose) {
  const AreaHeader& area = database.area();
  std::string text;
  for (std::size_t k = 0; k < area.color_maps.size(); ++k) {
    text += fmt::format("  colour map      {}: {}{}, {} nodes\n", area.color_maps[k].name,
                        area.color_maps[k].origin, sourcesText(area.color_maps[k]),
                        database.colorMaps()[k].directory().node_count);
  }
  for (std::size_t k = 0; k < area.models.size(); ++k) {
    const ModelTree& tree = database.models()[k].tree();
    text += fmt::format("  model           {}: {}{}, {} part{}\n", area.models[k].name, area.models[k].origin,
                        sourcesText(area.models[k]), tree.parts.size(), tree.parts.size() == 1 ? "" : "s");
    if (!verbose) continue;
    for (const ModelPart& part : tree.parts) text += partText(part);
  }
  if (const std::uint32_t count = placementCount(database); count > 0)
    text += fmt::format("  placements      {}\n", count);
  return text;
}

}  // namespace deltaz
