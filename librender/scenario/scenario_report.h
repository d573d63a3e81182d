// Tables 25, 26, 28 and 29 of Table 25's scene, for `dbview ars-report`: object_tables.h as rows with names
// and notes. Cost: seconds; the scene is built in memory. Errors: those of building and drawing.
// Thread-safety: reentrant, but times want the machine.
#pragma once

#include <vector>

#include "formats/error.h"
#include "librender/ars/experiments/report_row.h"

namespace deltaz {

// Identifiers are of what is counted: "table26.shared", "table29.no_levels.faces". Times, and what is made of
// them, are those of `rounds` rounds on this machine; all else is the same everywhere.
Result<std::vector<ars::ReportRow>> scenarioReportRows(int rounds);

}  // namespace deltaz
