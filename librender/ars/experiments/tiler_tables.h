// The report's measurements of one tiler, made again (Tables 21 to 24, Figs 87 to 90; report 7.1.2).
//
// The triangles of the report are not described. Ours are three uniform points in a square, large areas drawn
// again, with square and limit fitted to the two mean sizes of each row and to nothing else. That gives the
// oversampling columns. The undersampling ones jump between 157 and 203 pixels, and so do the triangles: (aO
// - aU)^2 / aU, which grows with elongation and not with size, is 12.6 to 18.3 in rows 2 to 6 and 9.7 to 10.0
// from row 7 on. Below the jump a few needles have to be among them, whose many empty lines undersampling
// looks through to the end of the box; with these all four columns come near. So the jump is one of test
// triangles, not of the algorithm.
//
// Deterministic. Cost: some 0.2 us a sampled line; a second for 20,000 triangles a row. Thread-safety:
// reentrant.
#pragma once

#include <vector>

#include "librender/ars/experiments/random_triangles.h"
#include "librender/ars/experiments/report_row.h"
#include "librender/ars/tiler/span_tiler.h"

namespace deltaz::ars {

inline constexpr int kTable23Rows = 11;
inline constexpr int kFirstNeedleRow = 1, kLastNeedleRow = 5;  // rows 2 to 6, counted from 0

// Row 0..10 of Tables 23 and 24.
TrianglePopulation plainPopulation(int row);
TrianglePopulation needlePopulation(int row);  // kFirstNeedleRow..kLastNeedleRow

// What one tiler makes of a population.
struct TilerMeasurement {
  TilingCounts counts;
  double seconds = 0;  // set-up and tiling machine at once, nothing behind them stopping

  double meanSize() const {
    return static_cast<double>(counts.tiled) / static_cast<double>(counts.triangles);
  }
  double efficiency() const {  // per cent
    return 100 * static_cast<double>(counts.tiled) / static_cast<double>(counts.sampled);
  }
  double rate() const { return static_cast<double>(counts.tiled) / seconds; }  // pixels a second
};
TilerMeasurement measureTiler(const TrianglePopulation& population, bool oversample, int triangles,
                              const TilerConfiguration& configuration = {});

// `triangles` a row; the report took two thousand.
std::vector<ReportRow> table21Rows();
std::vector<ReportRow> table22Rows();
std::vector<ReportRow> table23Rows(int triangles);
std::vector<ReportRow> table24Rows(int triangles);
std::vector<ReportRow> figure87To90Rows();
// All of them.
std::vector<ReportRow> tilerReportRows(int triangles);

}  // namespace deltaz::ars
