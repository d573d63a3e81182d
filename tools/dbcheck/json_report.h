// The report for programs; its shape is published in report.schema.json.
#pragma once

#include "tools/common/json_output.h"
#include "tools/dbcheck/verdict.h"

namespace deltaz {

// Holds neither time nor absolute paths, so that two reports can be compared.
Json jsonReport(const Report& report, const CheckRequest& request, const Judgement& judgement);

}  // namespace deltaz
