// Table 2 of the report: how far apart two surfaces must be for a depth format to tell them from each other,
// and that measured on the memory's format. Thread-safety: pure functions.
#pragma once

#include <vector>

#include "librender/ars/experiments/report_row.h"
#include "librender/ars/words/memory_depth.h"

namespace deltaz::ars {

// Half the distance to the next depth that the format holds, metres, at `u` metres.
double depthResolution(const DepthFormat& format, double u);

// The published figures are those of its formula for 1/U in floating point, U 2^-(M+1) with M = 19.
std::vector<ReportRow> table2Rows();

}  // namespace deltaz::ars
