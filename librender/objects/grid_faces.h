// Front faces of a terrain node as bits of its cells, so that faces of the node's own grid need no list: the
// test of terrainFaces on as many cells at a time as the processor takes, with the same result on every
// processor. Faces that are split stand in a list beside them. Thread-safety: pure functions.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "librender/objects/terrain_object_processor.h"

namespace deltaz {

// Readable bytes behind the last cell.
inline constexpr std::size_t kGridFacePadding = 16;

struct GridFaces {
  // Cells row by row from the south-west: bit 0 if the bottom face is drawn, bit 1 the top face; then the
  // padding, 0. Empty if there are none.
  std::vector<std::uint8_t> cells;
  std::uint64_t cells_in = 0, cells_back_facing = 0;  // as of TerrainFaces
  TerrainFaces listed;                                // fans of the faces that are split

  std::uint64_t in() const { return cells_in + listed.in; }
  std::uint64_t backFacing() const { return cells_back_facing + listed.back_facing; }
};

// The same faces as terrainFaces gives, and the same counts.
GridFaces gridFaces(const TerrainTile& tile, const std::vector<Vector3>& position,
                    const TerrainSplits& splits = {}, const std::vector<std::uint8_t>& left_out = {});

}  // namespace deltaz
