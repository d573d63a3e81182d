// What `dbbuild info` says of colour maps, models and placements.
#pragma once

#include <string>

#include "libdb/access/database.h"
#include "tools/common/json_output.h"

namespace deltaz {

Json colorMapsJson(const Database& database);
// With every part's name, parent and levels of detail: the names --pose takes.
Json modelsJson(const Database& database);
// Every placement. Errors: whatever reading reports.
Result<Json> placementsJson(const Database& database);

// Lines for people; with `verbose` the parts of models too.
std::string assetsText(const Database& database, bool verbose);

}  // namespace deltaz
