#include "tests/support/asset_editor.h"

#include <algorithm>
#include <stdexcept>

#include "libdb/access/referenced_file.h"
#include "tests/support/container_surgery.h"
#include "tests/support/synthetic_grid.h"

namespace deltaz {
namespace {

template <typename T>
T valueOrThrow(Result<T> result) {
  if (!result.ok()) throw std::runtime_error(result.error().message());
  return std::move(result).value();
}

std::string areaPath() {
  return kMemoryDatabasePath + "/" + std::string(kAreaFileName);
}

FileReference& referenceOf(AreaHeader& area, FileRole role, std::uint32_t number) {
  for (FileReference& file : area.files) {
    if (file.role == role && file.segment == number) return file;
  }
  throw std::runtime_error("the database has no such file");
}

}  // namespace

AreaHeader areaOf(const MemoryFileSystem& files) {
  return valueOrThrow(parseArea(files.text(areaPath()), areaPath()));
}

void setArea(MemoryFileSystem& files, const AreaHeader& area) {
  files.setText(areaPath(), serializeArea(area));
}

std::string assetPath(const MemoryFileSystem& files, FileRole role, std::uint32_t number) {
  AreaHeader area = areaOf(files);
  return kMemoryDatabasePath + "/" + referenceOf(area, role, number).name;
}

void changeAsset(MemoryFileSystem& files, FileRole role, std::uint32_t number,
                 const std::function<void(std::vector<AssetBlock>&)>& change) {
  AreaHeader area = areaOf(files);
  FileReference& reference = referenceOf(area, role, number);
  const std::string path = kMemoryDatabasePath + "/" + reference.name;
  std::vector<AssetBlock> blocks;
  for (std::uint32_t block = 0; block < blockCount(files.bytes(path)); ++block)
    blocks.push_back({entryOf(files.bytes(path), block).type, payloadOf(files.bytes(path), block)});
  change(blocks);
  valueOrThrow(files.removeFile(path));
  ContainerWriter writer = valueOrThrow(ContainerWriter::create(files, path, contentKindOf(role)));
  for (const AssetBlock& block : blocks) valueOrThrow(writer.append(block.type, block.payload));
  const FileIdentity identity = valueOrThrow(writer.finish());
  reference.length = identity.length;
  reference.id = identity.id;
  setArea(files, area);
}

std::vector<std::uint8_t> ColorParts::texels(const ColorNode& node) const {
  return valueOrThrow(decodeColorTile(tiles.at(node.block), "tile"));
}

void ColorParts::setTexels(const ColorNode& node, const std::vector<std::uint8_t>& texels) {
  tiles.at(node.block) = encodeColorTile(texels);
}

const ColorNode* ColorParts::beside(const ColorNode& node, int dx, int dy) const {
  const auto found = std::find_if(nodes.begin(), nodes.end(), [&](const ColorNode& other) {
    return other.grid == node.grid && other.level == node.level && other.x == node.x + dx &&
           other.y == node.y + dy;
  });
  return found == nodes.end() ? nullptr : &*found;
}

void changeColors(MemoryFileSystem& files, const std::function<void(ColorParts&)>& change) {
  changeAsset(files, FileRole::kColors, 0, [&](std::vector<AssetBlock>& blocks) {
    ColorParts parts;
    const auto count = static_cast<std::uint32_t>(blocks.size());
    for (const AssetBlock& block : blocks) {
      if (block.type == BlockType::kColorTile) {
        parts.tiles.push_back(block.payload);
      } else if (block.type == BlockType::kColorPage) {
        const auto nodes = valueOrThrow(decodeColorPage(block.payload, "page"));
        parts.nodes.insert(parts.nodes.end(), nodes.begin(), nodes.end());
      } else {
        parts.directory = valueOrThrow(decodeColorDirectory(block.payload, count, "directory"));
      }
    }
    change(parts);
    blocks.clear();
    for (const auto& tile : parts.tiles) blocks.push_back({BlockType::kColorTile, tile});
    for (std::size_t begin = 0; begin < parts.nodes.size(); begin += kColorNodesPerPage) {
      const std::size_t size = std::min<std::size_t>(kColorNodesPerPage, parts.nodes.size() - begin);
      blocks.push_back({BlockType::kColorPage, encodeColorPage(std::span(parts.nodes).subspan(begin, size))});
    }
    blocks.push_back({BlockType::kColorDirectory, encodeColorDirectory(parts.directory)});
  });
}

void changeModel(MemoryFileSystem& files, const std::function<void(ModelParts&)>& change) {
  changeAsset(files, FileRole::kModel, 0, [&](std::vector<AssetBlock>& blocks) {
    ModelParts parts;
    const auto count = static_cast<std::uint32_t>(blocks.size());
    for (const AssetBlock& block : blocks) {
      if (block.type == BlockType::kModelMesh) {
        parts.meshes.push_back(valueOrThrow(decodeModelMesh(block.payload, "mesh")));
      } else {
        parts.tree = valueOrThrow(decodeModelTree(block.payload, count, "tree"));
      }
    }
    change(parts);
    blocks.clear();
    for (const ModelMesh& mesh : parts.meshes)
      blocks.push_back({BlockType::kModelMesh, encodeModelMesh(mesh)});
    blocks.push_back({BlockType::kModelTree, encodeModelTree(parts.tree)});
  });
}

void changePlacements(MemoryFileSystem& files, const std::function<void(PlacementParts&)>& change) {
  const std::size_t models = areaOf(files).models.size();
  changeAsset(files, FileRole::kPlacements, 0, [&](std::vector<AssetBlock>& blocks) {
    PlacementParts parts;
    const auto count = static_cast<std::uint32_t>(blocks.size());
    for (const AssetBlock& block : blocks) {
      if (block.type == BlockType::kPlacementPage) {
        parts.pages.push_back(valueOrThrow(decodePlacementPage(block.payload, models, "page")));
      } else {
        parts.directory = valueOrThrow(decodePlacementDirectory(block.payload, count, "directory"));
      }
    }
    change(parts);
    blocks.clear();
    for (const auto& page : parts.pages)
      blocks.push_back({BlockType::kPlacementPage, encodePlacementPage(page)});
    blocks.push_back({BlockType::kPlacementDirectory, encodePlacementDirectory(parts.directory)});
  });
}

}  // namespace deltaz
