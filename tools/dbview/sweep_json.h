// What dbview sweep found, for programs; specified in dbview(1), SWEEP.
#pragma once

#include "tools/common/json_output.h"
#include "tools/dbview/sweep_report.h"

namespace deltaz {

Json sweepJson(const SweepReport& report);

}  // namespace deltaz
