#include "tests/support/database_editor.h"

#include <algorithm>
#include <stdexcept>

#include "tests/support/container_surgery.h"

namespace deltaz {
namespace {

template <typename T>
T valueOrThrow(Result<T> result) {
  if (!result.ok()) throw std::runtime_error(result.error().message());
  return std::move(result).value();
}

}  // namespace

DatabaseEditor::DatabaseEditor(MemoryFileSystem& files, const std::string& path)
    : files_(files), path_(path) {
  area = valueOrThrow(parseArea(files.text(areaPath()), areaPath()));
  if (area.grids.size() != 1 || area.files.size() != 2)
    throw std::runtime_error("one grid and one segment expected");
  for (const FileReference& file : area.files) {
    (file.role == FileRole::kNodes ? node_reference_name_ : terrain_reference_name_) = file.name;
  }
  const FileBytes& nodes = files.bytes(nodePath());
  for (std::uint32_t page = 0; page < blockCount(nodes); ++page) {
    const auto decoded =
        valueOrThrow(decodeNodePage(payloadOf(nodes, page), page * area.nodes_per_page + 1, nodePath()));
    records.insert(records.end(), decoded.begin(), decoded.end());
  }
  const FileBytes& terrain = files.bytes(terrainPath());
  for (std::uint32_t number = 0; number < blockCount(terrain); ++number)
    payloads.push_back(payloadOf(terrain, number));
}

std::string DatabaseEditor::areaPath() const {
  return path_ + "/" + std::string(kAreaFileName);
}

std::uint32_t DatabaseEditor::numberAt(int level, std::int32_t x, std::int32_t y) const {
  for (std::size_t i = 0; i < records.size(); ++i) {
    const NodeRecord& node = records[i];
    if (node.type == NodeType::kTerrain && node.level == level && node.x == x && node.y == y) {
      return static_cast<std::uint32_t>(i + 1);
    }
  }
  throw std::runtime_error("no node there");
}

std::uint32_t DatabaseEditor::firstOf(int level) const {
  const auto found = std::find_if(records.begin(), records.end(), [&](const NodeRecord& node) {
    return node.type == NodeType::kTerrain && node.level == level;
  });
  if (found == records.end()) throw std::runtime_error("no such level");
  return static_cast<std::uint32_t>(found - records.begin() + 1);
}

TerrainBlock DatabaseEditor::block(std::uint32_t number) const {
  const auto leaf_cells = static_cast<std::uint32_t>(area.grids[0].leaf_cells);
  return valueOrThrow(
      decodeTerrainBlock(payloads.at(records.at(number - 1).block), leaf_cells, terrainPath()));
}

void DatabaseEditor::setBlock(std::uint32_t number, const TerrainBlock& block) {
  payloads.at(record(number).block) = encodeTerrainBlock(block);
}

void DatabaseEditor::refreshReferences() {
  for (FileReference& file : area.files) {
    const FileIdentity identity = identityOf(files_.bytes(path_ + "/" + file.name));
    file.length = identity.length;
    file.id = identity.id;
  }
}

void DatabaseEditor::save() {
  std::vector<std::vector<std::byte>> pages;
  for (std::size_t first = 0; first < records.size(); first += area.nodes_per_page) {
    pages.push_back(encodeNodePage(
        std::span(records).subspan(first, std::min<std::size_t>(area.nodes_per_page, records.size() - first)),
        static_cast<std::uint32_t>(first + 1)));
  }
  files_.setBytes(nodePath(), makeContainer(ContentKind::kNodes, BlockType::kPackedNodePage, pages));
  files_.setBytes(terrainPath(), makeContainer(ContentKind::kTerrain, BlockType::kTerrainNode, payloads));
  area.node_count = static_cast<std::uint32_t>(records.size());
  saveArea(true);
}

void DatabaseEditor::saveArea(bool refresh) {
  if (refresh) refreshReferences();
  files_.setText(areaPath(), serializeArea(area));
}

std::string sealAreaText(const std::string& text) {
  const std::string lead = ",\n  \"hash\": \"";
  const std::size_t end = text.rfind(lead);
  if (end == std::string::npos) throw std::runtime_error("no hash in the text");
  const std::string body = text.substr(0, end);
  return body + lead + toHex(hash128(std::as_bytes(std::span(body)))) + "\"\n}\n";
}

}  // namespace deltaz
