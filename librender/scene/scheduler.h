// Chooses what is drawn: a cut through the area's quadtrees in which every node in view has errors that
// project to no more than the tolerance, whatever the levels of its neighbours.
//
// A node is refined while its geometric or its coverage error projects to more than the tolerance, and while
// the eye is inside its bounding volume and its error is not zero. Nodes that cannot be seen, because they
// are out of view, below the horizon or turned away, stay as they are. Where two levels meet, the finer
// node's border follows the coarser one's edges (objects/border_stitcher.h), so along that strip both levels'
// errors add: the coarser node is refined until the sum projects to no more than the tolerance, too.
// Neighbours may differ by any number of levels.
//
// Reads only the node pages of nodes in the cut and of their siblings. Thread-safety: pure functions.
#pragma once

#include <cstdint>
#include <vector>

#include "formats/error.h"
#include "libdb/access/database.h"
#include "librender/scene/cut.h"
#include "librender/scene/projected_error.h"
#include "librender/scene/render.h"
#include "librender/scene/seam_index.h"

namespace deltaz {

struct Schedule {
  int level = 0, coarsest_level = 0;  // of the nodes in view
  double projected_error = 0;         // pixels: the largest bound of what is drawn, strips included
  // The cut, in the order of the record numbers. It covers all of the area that has heights, but for what
  // lies under other grids.
  std::vector<CutNode> nodes;
  // Indices into `nodes` of those in view, nearest first: by the least distance between the eye and the
  // node's sphere, those equally near by record number. Nothing a node draws is nearer than that distance.
  std::vector<std::uint32_t> front_to_back;
};

struct ScheduleOptions {
  double tolerance = 1;  // pixels; 0 for full resolution
  int fixed_level = -1;  // >= 0: this level everywhere (at most the coarsest)
  // For tests that must see the contract fail: leaves the strips untested.
  bool test_strips = true;
  // For tests of culling: false takes everything for seen.
  bool cull = true;
};

// Counts in `statistics` the nodes visited, those not opened because nothing of them can be seen (by the
// first reason that was found), and those drawn. Nodes that `seams` touch are drawn at full resolution,
// whatever the tolerance.
Result<Schedule> scheduleNodes(const Database& database, const SeamIndex& seams, const ViewTransform& view,
                               const ScheduleOptions& options, FrameStatistics::Nodes& statistics);

}  // namespace deltaz
