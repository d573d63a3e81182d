// Where a terrain node stands in its grid's quadtree, and a hash of it for tables.
#pragma once

#include <cstddef>
#include <cstdint>

#include "formats/node_file.h"

namespace deltaz {

struct NodePosition {
  std::uint16_t grid = 0;
  std::uint8_t level = 0;
  std::int32_t x = 0, y = 0;
  bool operator==(const NodePosition&) const = default;
};

inline NodePosition positionOf(const NodeRecord& record) {
  return {record.grid, record.level, record.x, record.y};
}

struct NodePositionHash {
  std::size_t operator()(const NodePosition& position) const {
    std::uint64_t value = static_cast<std::uint32_t>(position.x);
    value = (value << 32) | static_cast<std::uint32_t>(position.y);
    value = (value ^ (value >> 29)) * 0xBF58476D1CE4E5B9u;
    value += (static_cast<std::uint64_t>(position.grid) << 8 | position.level) * 0x94D049BB133111EBu;
    return static_cast<std::size_t>(value ^ (value >> 32));
  }
};

}  // namespace deltaz
