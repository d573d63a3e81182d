// What the corrections that the report's tiler does not have are worth (tiler_configuration.h), measured with
// each off and on.
//
// Deterministic. Cost: some hundred milliseconds. Thread-safety: reentrant.
#pragma once

#include <vector>

#include "librender/ars/experiments/report_row.h"
#include "librender/ars/words/projected_triangle.h"

namespace deltaz::ars {

// A plain of 120 x 120 cells of 90 m, heights within 10 m, seen from 180 m above along the ground, 32 degrees
// across 512 pixels; what the screen would clip is left out. Colours are 0 to 255 at random.
std::vector<ProjectedTriangle> grazingTerrain();

// cells x cells squares of `pitch` pixels, inner vertices moved at random, so little that no triangle turns
// over.
std::vector<ProjectedTriangle> randomMesh(int cells, int pitch);

// Ids "correction.top_left_rule.lattice.off" and ".on"; nothing is published.
std::vector<ReportRow> correctionRows();

}  // namespace deltaz::ars
