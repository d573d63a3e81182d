// How far the valid region of a coarser level lies, in plan, from the full-resolution one (node_file.md,
// "Coverage error").
#pragma once

#include <cstdint>

#include "libdb/access/grid_geometry.h"
#include "libdb/source/elevation_source.h"

namespace deltaz {

// Coverage error of node (x, y) of level `level` >= 1 in kErrorUnit, rounded up; kUnknownError where the node
// draws nothing although something below it is valid. Never too small; too large by at most
// coverageSlack(...). `voids` false promises that every post in the node's extent is valid.
// Cost: O(posts in the extent) where there are voids, else constant. Memory then: ten bytes a post.
std::uint32_t coverageError(const RawGrid& grid, const GridGeometry& geometry, int level, std::int32_t x,
                            std::int32_t y, bool voids);

}  // namespace deltaz
