// What dbview sweep found, as a picture: time against displacement and against the error of colours, over all
// views, with the fronts.
#pragma once

#include <string>

#include "tools/dbview/sweep_report.h"

namespace deltaz {

std::string sweepSvg(const SweepReport& report);

}  // namespace deltaz
