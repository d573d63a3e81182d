#include "libdb/check/tile_loader.h"

#include <fmt/format.h>

#include "libdb/check/report_detail.h"

namespace deltaz {

Result<TilePointer> TileLoader::decode(std::uint32_t number) const {
  const NodeRecord& record = context_.record(number);
  const auto segment = context_.segments.find(record.segment);
  if (segment == context_.segments.end() || !segment->second->container) {
    return invalidError(IssueCode::kRefData, context_.path,
                        fmt::format("segment {} could not be opened", record.segment));
  }
  const ContainerReader& container = *segment->second->container;
  const GridGeometry& geometry = context_.grids[record.grid];
  const std::string where = fmt::format("{}, block {}", container.path(), record.block);
  DELTAZ_TRY_ASSIGN(const std::vector<std::byte> bytes,
                    container.read(record.block, BlockType::kTerrainNode));
  const auto leaf_cells = static_cast<std::uint32_t>(geometry.header().leaf_cells);
  DELTAZ_TRY_ASSIGN(TerrainBlock block, decodeTerrainBlock(bytes, leaf_cells, where));
  LoadedTile tile;
  tile.columns = geometry.nodePosts(geometry.columnsAt(record.level), record.x);
  tile.rows = geometry.nodePosts(geometry.rowsAt(record.level), record.y);
  const std::int64_t first_column = static_cast<std::int64_t>(record.x) * leaf_cells + block.first_column;
  const std::int64_t first_row = static_cast<std::int64_t>(record.y) * leaf_cells + block.first_row;
  if (block.columns != tile.columns.size() || block.rows != tile.rows.size() ||
      (block.columns > 0 && first_column != tile.columns.begin) ||
      (block.rows > 0 && first_row != tile.rows.begin)) {
    return invalidError(
        IssueCode::kTileGrid, where,
        fmt::format("the block holds {} x {} posts from ({}, {}) on, the node's place has {} x {}",
                    block.columns, block.rows, block.first_column, block.first_row, tile.columns.size(),
                    tile.rows.size()));
  }
  tile.block = std::move(block);
  return TilePointer(std::make_shared<const LoadedTile>(std::move(tile)));
}

Result<TilePointer> TileLoader::load(std::uint32_t number) {
  {
    const std::lock_guard guard(mutex_);
    if (const auto found = places_.find(number); found != places_.end()) {
      entries_.splice(entries_.begin(), entries_, found->second);
      return found->second->tile;
    }
  }
  // Two threads may decode the same node at once; that is cheaper than waiting for each other.
  auto decoded = decode(number);
  const std::lock_guard guard(mutex_);
  if (!decoded.ok()) {
    if (decoded.error().kind != ErrorKind::kInvalid && !refused_) refused_ = decoded.error();
    return decoded.error();
  }
  TilePointer tile = std::move(decoded).value();
  if (places_.contains(number)) return tile;
  const std::size_t posts = tile->block.heights.size();
  entries_.push_front({number, tile, posts * (sizeof(std::int32_t) + 1) + sizeof(LoadedTile)});
  places_[number] = entries_.begin();
  bytes_ += entries_.front().bytes;
  while (bytes_ > kTileCacheBytes && entries_.size() > 1) {
    bytes_ -= entries_.back().bytes;
    places_.erase(entries_.back().number);
    entries_.pop_back();
  }
  return tile;
}

TilePointer TileLoader::find(std::uint32_t number) {
  if (number == 0) return nullptr;
  auto tile = load(number);
  return tile.ok() ? std::move(tile).value() : nullptr;
}

void TileLoader::reportRefusedReads(Report& report) const {
  if (refused_ && !report.fatal) addError(report, *refused_);
}

}  // namespace deltaz
