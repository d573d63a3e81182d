// Decoded terrain for the rules, many of which look at the same nodes: a cache of bounded size in front of
// the segments. Internal to libdb/check. Thread-safety: all members from any thread.
#pragma once

#include <algorithm>
#include <cstdint>
#include <list>
#include <memory>
#include <mutex>
#include <optional>
#include <unordered_map>
#include <utility>

#include "formats/error.h"
#include "formats/terrain_segment.h"
#include "libdb/check/check_context.h"

namespace deltaz {

inline constexpr std::size_t kTileCacheBytes = 64u << 20;

// A node's terrain and where its own posts stand, in indices of its level.
struct LoadedTile {
  TerrainBlock block;
  PostRange columns, rows;

  bool hasPosts() const { return columns.size() > 0 && rows.size() > 0; }
  // Place of post (column, row) in block.heights; the ring's included.
  std::size_t index(std::int64_t column, std::int64_t row) const {
    return static_cast<std::size_t>((row - rows.begin + 1) * (columns.size() + 2) +
                                    (column - columns.begin + 1));
  }
  bool isValid(std::int64_t column, std::int64_t row) const { return block.valid[index(column, row)] != 0; }
  std::int32_t height(std::int64_t column, std::int64_t row) const {
    return block.heights[index(column, row)];
  }
};

using TilePointer = std::shared_ptr<const LoadedTile>;

class TileLoader {
 public:
  explicit TileLoader(CheckContext& context) : context_(context) {}

  // The terrain of record `number`. Fails as reading fails, and with kTileGrid if the block's shape is not
  // that of the node's place, so that whoever gets a tile can index it by that place.
  Result<TilePointer> load(std::uint32_t number);
  // The same, but nothing for a node that is not there (0) or whose failure is reported elsewhere.
  TilePointer find(std::uint32_t number);
  // Reports that the system refused a read, if nobody has yet: a node read well once may fail the next time,
  // and what find() could not compare must not pass for compared.
  void reportRefusedReads(Report& report) const;

 private:
  Result<TilePointer> decode(std::uint32_t number) const;

  struct Entry {
    std::uint32_t number = 0;
    TilePointer tile;
    std::size_t bytes = 0;
  };
  CheckContext& context_;
  std::mutex mutex_;
  std::list<Entry> entries_;  // last used first
  std::unordered_map<std::uint32_t, std::list<Entry>::iterator> places_;
  std::size_t bytes_ = 0;
  std::optional<Error> refused_;
};

// Which node along one axis answers for post `post` of a level: the one it opens, and the last one for its
// end.
inline std::int64_t ownerOf(std::int64_t post, std::int64_t leaf_cells, PostRange nodes) {
  return std::min(floorDivide(post, leaf_cells), nodes.end - 1);
}

}  // namespace deltaz
