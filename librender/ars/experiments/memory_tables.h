// The report's measurements of memories and distribution tree, made again (Tables 19 and 20, Figs 29, 30, 84,
// 85, 91, 92; report 4.3.3.3, 7.1.1, 7.1.3), and what the machine takes for a frame as large as its
// scenario's (Table 25).
//
// Two thousand random triangles of some 122 pixels, as in Table 20, each facing the eye at a depth of its own
// in one of three octaves: the report does not say what depths it drew, and three octaves give its mix of
// look-ahead and read-compare cycles. For the tree their centres scatter by 55 lines about mid-screen, which
// gives the memories of the sequential mode about as unequal a share as Fig 92 must have shown. The curves of
// the figures are lost; where only their text is left, that is what stands as published.
//
// Deterministic. Cost: two seconds for all. Thread-safety: reentrant.
#pragma once

#include <vector>

#include "librender/ars/experiments/report_row.h"
#include "librender/ars/machine/triangle_source.h"

namespace deltaz::ars {

// What these experiments draw, oversampled.
struct MemoryLoad {
  int triangles = 2000;
  double line_sigma = 0;  // of centres about mid-screen; 0: anywhere
  std::uint64_t seed = 20;
};
TriangleSource memoryLoad(const MemoryLoad& load);

std::vector<ReportRow> table19Rows();
std::vector<ReportRow> table20Rows();
std::vector<ReportRow> figure29Rows();
std::vector<ReportRow> figure30Rows();
std::vector<ReportRow> figure84And85Rows();
std::vector<ReportRow> figure91And92Rows();
std::vector<ReportRow> table25Rows();
// All of them.
std::vector<ReportRow> memoryReportRows();

}  // namespace deltaz::ars
