// dbview sweep: what accuracy costs, for a database and views of the user's own. See dbview(1), SWEEP.
#pragma once

#include "tools/dbview/sweep_options.h"

namespace deltaz {

// The exit code. Errors: those of parseSweep, reading, rendering and writing.
Result<int> runSweep(const SweepOptions& options);

}  // namespace deltaz
