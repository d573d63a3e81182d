// How many triangles are left of a node if it is opened, and of what is below it what cannot be seen left
// out.
//
// The volume of a coarse node is as wide as it covers ground, so it reaches into the picture, or above the
// ridge before it, with a corner at most, and all of its triangles are paid for. Nodes of every level draw
// about as many triangles, so the nodes below may draw fewer than it does. Answered without a read: the parts
// of a node are where their posts are, and their heights taken for those of the node. So this is an estimate,
// to choose by what may be chosen freely, and never a reason to leave something out.
#pragma once

#include <cstdint>
#include <functional>

#include "libdb/access/database.h"
#include "libdb/access/node_position.h"
#include "librender/scene/node_volume.h"

namespace deltaz {

// Triangles of the full grid of posts under a terrain node, within the area, at that or a finer level.
std::uint64_t gridTriangles(const GridGeometry& grid, const NodePosition& position, int level);

// True if the quarters of the terrain node that `may_see` holds for draw fewer triangles than the node
// itself. Cost: four volumes.
bool drawsFewerOpened(const Node& node, const GridGeometry& grid,
                      const std::function<bool(const NodeVolume&)>& may_see);

}  // namespace deltaz
