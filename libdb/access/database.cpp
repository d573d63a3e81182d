#include "libdb/access/database.h"

#include <algorithm>
#include <fmt/format.h>
#include <limits>

#include "libdb/access/node_pages.h"
#include "libdb/access/referenced_file.h"

namespace deltaz {

namespace {

double errorInMetres(std::uint32_t units) {
  return units == kUnknownError ? std::numeric_limits<double>::infinity()
                                : static_cast<double>(units) * kErrorUnit;
}

Node makeNode(std::uint32_t number, const NodeRecord& record,
              const std::array<std::int64_t, 3>& parent_centroid) {
  Node node;
  node.number = number;
  node.record = record;
  for (std::size_t i = 0; i < 3; ++i) node.centroid_units[i] = parent_centroid[i] + record.centroid_offset[i];
  node.centroid = {static_cast<double>(node.centroid_units[0]) * kCentroidUnit,
                   static_cast<double>(node.centroid_units[1]) * kCentroidUnit,
                   static_cast<double>(node.centroid_units[2]) * kCentroidUnit};
  return node;
}

// Opens a file named in area.json and compares it with what stands there.
Result<std::unique_ptr<ContainerReader>> openReferenced(const FileSystem& files, const std::string& folder,
                                                        const FileReference& reference) {
  const std::string path = joinPath(folder, reference.name);
  DELTAZ_TRY_ASSIGN(const PathType type, files.typeOf(path));
  if (type == PathType::kAbsent) {
    Error error =
        accessError(path, "a file of the database is missing", {}, "Restore it or rebuild the database");
    error.kind = ErrorKind::kInvalid;
    error.code = IssueCode::kIoMissingFile;
    return error;
  }
  const ContentKind kind = contentKindOf(reference.role);
  DELTAZ_TRY_ASSIGN(ContainerReader reader, ContainerReader::open(files, path, kind));
  if (reader.identity().length != reference.length || reader.identity().id != reference.id) {
    return invalidError(IssueCode::kManFileMismatch, path, "the file is not the one area.json names",
                        "it belongs to another database or another state of this one",
                        "Restore it or rebuild the database");
  }
  return std::make_unique<ContainerReader>(std::move(reader));
}

// What is wrong with `child` as a child of `parent`; empty if nothing. A tree that passes here has as many
// nodes as records, however it was damaged.
std::string faultOfChild(const NodeRecord& parent, const NodeRecord& child,
                         const std::vector<GridHeader>& grids) {
  if (child.grid >= grids.size()) return "it names a grid that is not there";
  if (parent.type == NodeType::kTerrain) {
    const bool below = child.type == NodeType::kTerrain && child.grid == parent.grid &&
                       child.level + 1 == parent.level && (child.x >> 1) == parent.x &&
                       (child.y >> 1) == parent.y;
    return below ? "" : "its level or place is not below its parent's";
  }
  if (child.type == NodeType::kTerrain) {
    return child.level + 1 == grids[child.grid].level_count ? ""
                                                            : "its level is not the coarsest of its grid";
  }
  return child.level == grids[child.grid].level_count && parent.level == kAreaLevel
             ? ""
             : "a cluster stands under a grid";
}

}  // namespace

double Node::geometricError() const {
  return errorInMetres(record.geometric_error);
}
double Node::coverageError() const {
  return errorInMetres(record.coverage_error);
}

Result<Database> Database::open(const FileSystem& files, const std::string& path) {
  // A writer may replace the database between our reading of area.json and our opening of its files: then the
  // new state is opened instead. Several replacements in a row are possible, endless ones are not.
  constexpr int kAttempts = 5;
  const std::string area_path = joinPath(path, std::string(kAreaFileName));
  for (int attempt = 1;; ++attempt) {
    std::vector<std::byte> text;
    Result<Database> database = openOnce(files, path, text);
    if (database.ok() || attempt == kAttempts || text.empty()) return database;
    const Result<std::vector<std::byte>> now = readWholeFile(files, area_path, kMaximumAreaBytes);
    if (!now.ok() || now.value() == text) return database;
  }
}

Result<Database> Database::openOnce(const FileSystem& files, const std::string& path,
                                    std::vector<std::byte>& text) {
  DELTAZ_TRY_ASSIGN(const PathType type, files.typeOf(path));
  if (type == PathType::kAbsent)
    return accessError(path, "cannot open the database", "there is no such folder");
  if (type != PathType::kDirectory) {
    return invalidError(IssueCode::kManSyntax, path, "this is not a deltaz database",
                        "a database is a folder");
  }
  const std::string area_path = joinPath(path, std::string(kAreaFileName));
  DELTAZ_TRY_ASSIGN(const PathType area_type, files.typeOf(area_path));
  if (area_type == PathType::kAbsent) {
    return invalidError(IssueCode::kManSyntax, path, "this is not a deltaz database",
                        "there is no area.json in it");
  }
  DELTAZ_TRY_ASSIGN(text, readWholeFile(files, area_path, kMaximumAreaBytes));
  Database database;
  database.path_ = path;
  database.area_bytes_ = text.size();
  std::string characters(text.size(), '\0');
  std::transform(text.begin(), text.end(), characters.begin(),
                 [](std::byte b) { return static_cast<char>(b); });
  DELTAZ_TRY_ASSIGN(database.area_, parseArea(characters, area_path));
  std::vector<std::shared_ptr<const PatchLattice>> patches(database.area_.grids.size());
  for (const FileReference& reference : database.area_.files) {
    DELTAZ_TRY_ASSIGN(std::unique_ptr<ContainerReader> reader, openReferenced(files, path, reference));
    if (reference.role == FileRole::kNodes) {
      if (database.nodes_) return invalidError(IssueCode::kManField, area_path, "two node files are listed");
      database.nodes_ = std::move(reader);
      continue;
    }
    if (reference.role == FileRole::kPatches) {
      // A second lattice for one grid, or one for a grid that needs none, is a mistake of whoever wrote it.
      if (reference.segment >= patches.size() || patches[reference.segment] != nullptr ||
          !database.area_.grids[reference.segment].patches) {
        return invalidError(IssueCode::kManField, area_path,
                            fmt::format("file {} places no grid", reference.name));
      }
      DELTAZ_TRY_ASSIGN(patches[reference.segment],
                        readPatchLattice(*reader, *database.area_.grids[reference.segment].patches));
      database.patch_files_.push_back(std::move(reader));
      continue;
    }
    if (reference.role == FileRole::kSeams) {
      if (database.seam_file_)
        return invalidError(IssueCode::kManField, area_path, "two files of seams are listed");
      for (std::uint32_t block = 0; block < reader->blockCount(); ++block) {
        DELTAZ_TRY_ASSIGN(const std::vector<std::byte> bytes, reader->read(block, BlockType::kSeam));
        DELTAZ_TRY_ASSIGN(Seam seam, decodeSeam(bytes, database.area_.grids,
                                                fmt::format("{}, block {}", reader->path(), block)));
        database.seams_.push_back(std::move(seam));
      }
      database.seam_file_ = std::move(reader);
      continue;
    }
    if (reference.role != FileRole::kTerrain) {
      DELTAZ_TRY(database.addAsset(reference, std::move(reader)));
      continue;
    }
    if (reference.segment != database.segments_.size()) {
      return invalidError(IssueCode::kManField, area_path, "the terrain segments are not numbered in order");
    }
    database.segments_.push_back(std::move(reader));
  }
  for (std::size_t grid = 0; grid < patches.size(); ++grid) {
    const GridHeader& header = database.area_.grids[grid];
    if (header.patches && patches[grid] == nullptr) {
      return invalidError(IssueCode::kManField, area_path,
                          fmt::format("no file places the posts of grid {}", grid));
    }
    database.grids_.emplace_back(header, patches[grid]);
  }
  if (!database.nodes_) return invalidError(IssueCode::kManField, area_path, "no node file is listed");
  if (database.color_maps_.size() != database.area_.color_maps.size() ||
      database.models_.size() != database.area_.models.size()) {
    return invalidError(IssueCode::kManField, area_path,
                        "not every colour map and every model has its file listed");
  }
  const std::uint32_t pages = nodePageCount(database.area_);
  if (database.nodes_->blockCount() != pages) {
    return invalidError(IssueCode::kManField, area_path,
                        fmt::format("{} records need {} pages, the node file has {}",
                                    database.area_.node_count, pages, database.nodes_->blockCount()));
  }
  database.page_cache_ = std::make_unique<PageCache>();
  database.page_cache_->pages.resize(pages);
  return database;
}

Status Database::addAsset(const FileReference& reference, std::unique_ptr<ContainerReader> reader) {
  // Those of one kind are listed in the order of their headers.
  const auto expect = [&](std::size_t index, std::size_t count) -> Status {
    if (reference.segment == index && index < count) return Success{};
    return invalidError(IssueCode::kManField, joinPath(path_, std::string(kAreaFileName)),
                        fmt::format("file {} is listed out of order", reference.name));
  };
  if (reference.role == FileRole::kColors) {
    DELTAZ_TRY(expect(color_maps_.size(), area_.color_maps.size()));
    DELTAZ_TRY_ASSIGN(ColorMap map, ColorMap::open(std::move(reader), area_.grids));
    color_maps_.push_back(std::move(map));
  } else if (reference.role == FileRole::kModel) {
    DELTAZ_TRY(expect(models_.size(), area_.models.size()));
    DELTAZ_TRY_ASSIGN(Model model, Model::open(std::move(reader)));
    models_.push_back(std::move(model));
  } else {
    DELTAZ_TRY(expect(placements_ ? 1 : 0, 1));
    DELTAZ_TRY_ASSIGN(placements_, PlacementSet::open(std::move(reader), area_.models.size()));
  }
  return Success{};
}

std::optional<std::size_t> Database::findColorMap(std::string_view name) const {
  for (std::size_t k = 0; k < area_.color_maps.size(); ++k) {
    if (area_.color_maps[k].name == name) return k;
  }
  return std::nullopt;
}

std::optional<std::uint32_t> Database::findModel(std::string_view name) const {
  for (std::size_t k = 0; k < area_.models.size(); ++k) {
    if (area_.models[k].name == name) return static_cast<std::uint32_t>(k);
  }
  return std::nullopt;
}

const ContainerReader* Database::terrainSegment(std::uint32_t segment) const {
  return segment < segments_.size() ? segments_[segment].get() : nullptr;
}

Result<NodeRecord> Database::record(std::uint32_t number) const {
  if (number == 0 || number > area_.node_count) {
    return invalidError(IssueCode::kRefRange, nodes_->path(),
                        fmt::format("there is no record {}; the last is {}", number, area_.node_count));
  }
  const std::uint32_t page_number = (number - 1) / area_.nodes_per_page;
  const std::size_t slot = (number - 1) % area_.nodes_per_page;
  {
    const std::lock_guard guard(page_cache_->mutex);
    if (const auto& page = page_cache_->pages[page_number]) return (*page)[slot];
  }
  DELTAZ_TRY_ASSIGN(std::vector<NodeRecord> records, readNodePage(*nodes_, area_, page_number));
  const NodeRecord result = records[slot];
  const std::lock_guard guard(page_cache_->mutex);
  page_cache_->pages[page_number] = std::make_shared<const std::vector<NodeRecord>>(std::move(records));
  return result;
}

Result<Node> Database::root() const {
  DELTAZ_TRY_ASSIGN(const NodeRecord record_of_root, record(kRootRecord));
  if (record_of_root.type != NodeType::kCluster) {
    return invalidError(IssueCode::kRefRecord, nodes_->path(), "record 1 is not the area's cluster node");
  }
  return makeNode(kRootRecord, record_of_root, area_.centroid);
}

Result<std::vector<Node>> Database::children(const Node& parent) const {
  // Clusters may have any number of children up to the number of grids; quadtree nodes at most four.
  const std::size_t most =
      parent.record.type == NodeType::kCluster ? std::max<std::size_t>(4, area_.grids.size()) : 4;
  std::vector<Node> nodes;
  for (std::uint32_t number = parent.record.first_child; number != 0;) {
    // Children always stand behind their parent and in order, so a damaged file cannot lead in circles.
    const std::uint32_t before = nodes.empty() ? parent.number : nodes.back().number;
    if (number <= before || nodes.size() == most) {
      return invalidError(IssueCode::kRefCycle, nodes_->path(),
                          fmt::format("the children of record {} do not end", parent.number));
    }
    DELTAZ_TRY_ASSIGN(const NodeRecord child, record(number));
    if (const std::string fault = faultOfChild(parent.record, child, area_.grids); !fault.empty()) {
      return invalidError(IssueCode::kRefChild, nodes_->path(),
                          fmt::format("record {} cannot be a child of record {}", number, parent.number),
                          fault);
    }
    nodes.push_back(makeNode(number, child, parent.centroid_units));
    number = child.sibling;
  }
  return nodes;
}

Result<TerrainBlock> Database::terrainBlock(const NodeRecord& record) const {
  const ContainerReader* segment = terrainSegment(record.segment);
  if (segment == nullptr || record.type != NodeType::kTerrain || record.grid >= area_.grids.size()) {
    return invalidError(IssueCode::kRefData, nodes_->path(),
                        fmt::format("a node names terrain segment {}, which is not there", record.segment));
  }
  DELTAZ_TRY_ASSIGN(const std::vector<std::byte> bytes, segment->read(record.block, BlockType::kTerrainNode));
  return decodeTerrainBlock(bytes, static_cast<std::uint32_t>(area_.grids[record.grid].leaf_cells),
                            fmt::format("{}, block {}", segment->path(), record.block));
}

Result<TerrainTile> Database::terrain(const Node& node) const {
  DELTAZ_TRY_ASSIGN(TerrainBlock block, terrainBlock(node.record));
  const GridGeometry& geometry = grids_[node.record.grid];
  TerrainTile tile;
  tile.grid = node.record.grid;
  tile.level = node.record.level;
  tile.x = node.record.x;
  tile.y = node.record.y;
  tile.columns = block.columns;
  tile.rows = block.rows;
  const std::int64_t leaf = geometry.header().leaf_cells;
  tile.first_column = tile.x * leaf + block.first_column;
  tile.first_row = tile.y * leaf + block.first_row;
  // The block must be this node's: its posts are those of the area at the node's place.
  const PostRange columns = geometry.nodePosts(geometry.columnsAt(tile.level), tile.x);
  const PostRange rows = geometry.nodePosts(geometry.rowsAt(tile.level), tile.y);
  if (tile.columns != columns.size() || tile.rows != rows.size() ||
      (tile.columns > 0 && tile.first_column != columns.begin) ||
      (tile.rows > 0 && tile.first_row != rows.begin)) {
    return invalidError(
        IssueCode::kTileGrid, terrainSegment(node.record.segment)->path(),
        fmt::format("block {} does not hold the posts of record {}", node.record.block, node.number));
  }
  tile.heights = std::move(block.heights);
  tile.valid = std::move(block.valid);
  tile.void_kinds = std::move(block.void_kinds);
  for (const std::uint8_t kind : tile.void_kinds) {
    if (kind < std::max<std::size_t>(1, geometry.header().sentinels.size())) continue;
    return invalidError(IssueCode::kHgtDecode, terrainSegment(node.record.segment)->path(),
                        fmt::format("block {} has a void of kind {}", node.record.block, kind),
                        "the grid has no such sentinel");
  }
  return tile;
}

std::uint64_t Database::bytesRead() const {
  std::uint64_t bytes = area_bytes_ + nodes_->bytesRead();
  for (const auto& segment : segments_) bytes += segment->bytesRead();
  for (const auto& file : patch_files_) bytes += file->bytesRead();
  if (seam_file_) bytes += seam_file_->bytesRead();
  for (const ColorMap& map : color_maps_) bytes += map.file().bytesRead();
  for (const Model& model : models_) bytes += model.file().bytesRead();
  if (placements_) bytes += placements_->file().bytesRead();
  return bytes;
}

Result<std::vector<Node>> nodesOfLevel(const Database& database, int grid, int level) {
  DELTAZ_TRY_ASSIGN(const Node root, database.root());
  DELTAZ_TRY_ASSIGN(const std::vector<Node> clusters, database.children(root));
  std::vector<Node> current;
  for (const Node& cluster : clusters) {
    if (cluster.record.grid != grid) continue;
    DELTAZ_TRY_ASSIGN(current, database.children(cluster));
  }
  while (!current.empty() && current.front().record.level > level) {
    std::vector<Node> next;
    for (const Node& node : current) {
      DELTAZ_TRY_ASSIGN(const std::vector<Node> children, database.children(node));
      next.insert(next.end(), children.begin(), children.end());
    }
    current = std::move(next);
  }
  return current;
}

}  // namespace deltaz
