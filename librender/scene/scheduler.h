// Chooses what is drawn: the nodes in the view volume at one level of detail for the whole view, the coarsest
// at which the geometric error of every node in view projects to no more than the tolerance.
//
// Reads only the node pages of nodes in view and of their siblings. Nodes come in the order of their record
// numbers. One level for the whole view needs no stitching: neighbours share their border posts.
//
// Not yet tested: the coverage error. Databases of version 1 leave it unknown (infinite), so a coarse level
// may end short of the area's edge and of voids by up to one of its cells.
#pragma once

#include <vector>

#include "formats/error.h"
#include "libdb/access/database.h"
#include "librender/scene/render.h"

namespace deltaz {

struct Schedule {
  int level = 0;
  double projected_error = 0;  // pixels: the largest bound of the nodes drawn
  std::vector<Node> nodes;
};

// Bound, in pixels, of how far a displacement of at most `error` metres of points inside the sphere moves
// them on the screen, for points in the picture; infinity where the sphere reaches the eye. Never too small:
// a point at depth U and tangent p moves by |dp - p dU| / (U + dU) <= error sqrt(1 + p^2) / (U - error)
// tangents.
double projectedErrorBound(const ViewTransform& view, const Vector3& centre, double radius, double error);

// Counts visited, out_of_view and drawn nodes in `statistics`. `tolerance` in pixels, 0 for full resolution;
// `fixed_level` >= 0 overrides it (and is at most the coarsest level).
Result<Schedule> scheduleNodes(const Database& database, const ViewTransform& view, double tolerance,
                               int fixed_level, FrameStatistics::Nodes& statistics);

}  // namespace deltaz
