#include "libdb/build/color_map_edit.h"

#include <algorithm>
#include <fmt/format.h>

namespace deltaz {

namespace {

std::vector<AssetHeader>::const_iterator findMap(const AreaHeader& area, const std::string& name) {
  return std::find_if(area.color_maps.begin(), area.color_maps.end(),
                      [&](const AssetHeader& map) { return map.name == name; });
}

// Where a map's file stands in the list: those of colour maps in order, after the terrain's, before the
// models'.
std::vector<FileReference>::iterator fileOf(AreaHeader& area, std::uint32_t map) {
  return std::find_if(area.files.begin(), area.files.end(), [&](const FileReference& file) {
    return file.role == FileRole::kColors && file.segment == map;
  });
}

void insertFile(AreaHeader& area, const FileReference& reference) {
  const auto later = std::find_if(area.files.begin(), area.files.end(), [&](const FileReference& file) {
    return file.role == FileRole::kModel || file.role == FileRole::kPlacements ||
           (file.role == FileRole::kColors && file.segment > reference.segment);
  });
  area.files.insert(later, reference);
}

}  // namespace

Status checkColorMapName(const AreaHeader& area, const std::string& target, const std::string& name,
                         bool overwrite) {
  if (!isAssetName(name)) {
    return usageError("--name", fmt::format("'{}' is no name of a colour map", name),
                      "a name is 1 to 64 letters, digits, '_', '-' and inner dots, and not 'none'");
  }
  if (findMap(area, name) != area.color_maps.end() && !overwrite) {
    return usageError(target, fmt::format("there is a colour map '{}' already", name), {},
                      "Choose another --name or give --overwrite");
  }
  return Success{};
}

Result<std::uint64_t> addColorMap(
    const FileSystem& files, const std::string& target, const AssetHeader& header, bool overwrite,
    const std::function<Status(const AreaHeader& area, ColorMapWriter& writer)>& fill) {
  DELTAZ_TRY_ASSIGN(Publication publication, Publication::beginEdit(files, target));
  AreaHeader area = publication.area();
  DELTAZ_TRY(checkColorMapName(area, target, header.name, overwrite));
  const auto map = static_cast<std::uint32_t>(findMap(area, header.name) - area.color_maps.begin());
  const std::string name = fmt::format("colors-{:06}-{:03}.dzc", publication.generation(), map);
  DELTAZ_TRY_ASSIGN(ColorMapWriter writer, ColorMapWriter::create(files, publication.newFilePath(name)));
  DELTAZ_TRY(fill(area, writer));
  DELTAZ_TRY_ASSIGN(const FileIdentity identity, writer.finish());
  if (map < area.color_maps.size()) {
    area.color_maps[map] = header;
    area.files.erase(fileOf(area, map));
  } else {
    area.color_maps.push_back(header);
  }
  insertFile(area, {FileRole::kColors, map, name, identity.length, identity.id});
  DELTAZ_TRY(publication.publish(area));
  return identity.length;
}

Status removeColorMap(const FileSystem& files, const std::string& target, const std::string& name) {
  DELTAZ_TRY_ASSIGN(Publication publication, Publication::beginEdit(files, target));
  AreaHeader area = publication.area();
  const auto found = findMap(area, name);
  if (found == area.color_maps.end()) {
    std::string names;
    for (const AssetHeader& map : area.color_maps) names += (names.empty() ? "" : ", ") + map.name;
    return usageError(target, fmt::format("there is no colour map '{}'", name),
                      names.empty() ? "the database has none" : "it has " + names);
  }
  const auto map = static_cast<std::uint32_t>(found - area.color_maps.cbegin());
  area.color_maps.erase(found);
  area.files.erase(fileOf(area, map));
  for (FileReference& file : area.files) {
    if (file.role == FileRole::kColors && file.segment > map) --file.segment;
  }
  return publication.publish(area);
}

}  // namespace deltaz
