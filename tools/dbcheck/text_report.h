// The report for people: the verdict on the first line, then what was checked and what was found.
#pragma once

#include <string>

#include "tools/dbcheck/verdict.h"

namespace deltaz {

// `shown_locations` places are listed for each code; counts are exact whatever is shown.
std::string textReport(const Report& report, const CheckRequest& request, const Judgement& judgement,
                       std::size_t shown_locations);

}  // namespace deltaz
