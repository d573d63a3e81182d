// What a node record says about a node's extent: bounding sphere, height range, normal cone, steepest facet.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "formats/node_file.h"
#include "libdb/access/grid_geometry.h"
#include "libdb/access/terrain_tile.h"

namespace deltaz {

// Bounds of one node and everything below it, in the units of the node record.
struct NodeBounds {
  bool empty = true;                                    // no valid post
  std::array<std::int64_t, 3> centroid{};               // Earth-centred, kCentroidUnit
  std::uint32_t radius = 0;                             // kCentroidUnit, rounded up
  std::int32_t minimum_height = 0, maximum_height = 0;  // quanta
  std::array<std::int16_t, 3> mean_normal{};
  std::uint16_t cone_half_angle = 0;
  bool has_cone = false;  // false while no facet has been seen
};

// What a tile alone tells: its posts and its own facets.
struct TileSummary {
  NodeBounds bounds;
  std::uint32_t valid_posts = 0, void_posts = 0;
  std::uint32_t facets = 0;
  double steepest = 0;  // largest slope (tangent) of its facets against the ellipsoid
};
TileSummary summarizeTile(const TerrainTile& tile, const GridGeometry& geometry);

// The unit vector a stored mean normal stands for; up along x if it is zero.
Vector3 unpackNormal(const std::array<std::int16_t, 3>& packed);
// Radians of a stored cone half angle.
double coneAngle(std::uint16_t units);

// Widens the bounds of a node with posts so that they hold a further face it draws; its mean normal stays.
void includeFace(NodeBounds& bounds, const std::array<Vector3, 3>& face);

// Widens `parent` (as summarizeTile left it, possibly empty) so that it holds `children` too. A parent
// without posts of its own takes the middle of its children.
void includeChildren(NodeBounds& parent, std::span<const NodeBounds> children);

}  // namespace deltaz
