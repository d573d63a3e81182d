// All that a renderer needs of a tile's posts, as lists: what terrainVertices gives, bit for bit, without
// being gathered post by post. Normals and shading are the same whatever the transform of the positions.
//
// Work that several of them share (constants of rows and columns, places of a projected grid's posts) is done
// once. Lists that were used before are filled without allocating; scratch memory is the thread's own.
// Thread-safety: pure functions.
#pragma once

#include <cstdint>
#include <vector>

#include "libdb/access/grid_geometry.h"
#include "libdb/access/terrain_tile.h"
#include "librender/objects/terrain_shading.h"
#include "librender/objects/view_positions.h"
#include "librender/scene/illumination.h"
#include "librender/scene/transform_kind.h"

namespace deltaz {

// Posts row by row from the south-west, one entry a post, then ViewPositions::kPadding zeroes.
struct TerrainVertexLists {
  ViewPositions position;
  std::vector<double> intensity;
  PostColors color;  // by rule, times intensity
};

enum class PostColoring : std::uint8_t {
  kByRule,
  kNone,  // `color` is left as it is: all of the tile is under a colour map's cover
};

struct TerrainVertexOptions {
  PostColoring coloring = PostColoring::kByRule;
  TransformKind transform = TransformKind::kExact;
};

// Pre: a projected grid's geometry has its patches.
void terrainVertexLists(const TerrainTile& tile, const GridGeometry& geometry, const ViewTransform& view,
                        const Light& light, TerrainVertexLists& lists,
                        const TerrainVertexOptions& options = {});

}  // namespace deltaz
