// The quadtree of a grid before any file: which nodes there are, in which order, and what posts each holds.
// Every level is a subset of the finest (report 6.5.1); boundaries lie at global multiples.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "libdb/access/grid_geometry.h"
#include "libdb/access/terrain_tile.h"
#include "libdb/source/elevation_source.h"

namespace deltaz {

inline constexpr std::uint32_t kNoNode = 0xFFFFFFFF;

struct PlannedNode {
  int level = 0;
  std::int32_t x = 0, y = 0;
  std::uint8_t child_number = 0;        // 1 SW, 2 SE, 3 NE, 4 NW; 0 at the coarsest level
  std::uint32_t parent = kNoNode;       // index into PyramidPlan::nodes
  std::uint32_t first_child = kNoNode;  // children stand together
  std::uint32_t child_count = 0;
};

struct PyramidPlan {
  int level_count = 1;
  std::vector<PlannedNode> nodes;          // breadth first, coarsest level first
  std::vector<std::uint32_t> level_begin;  // nodes of level k are [level_begin[k], level_end[k])
  std::vector<std::uint32_t> level_end;
};

// Levels are added until the area is at most 2 x 2 nodes.
PyramidPlan planPyramid(const GridGeometry& geometry);

// The posts and ring of one node, cut from the whole grid. Posts outside the area are void with height 0.
TerrainTile cutTile(const RawGrid& grid, const GridGeometry& geometry, int level, std::int32_t x,
                    std::int32_t y);

}  // namespace deltaz
