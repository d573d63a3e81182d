// --list-codes and --explain, from the one registry of codes.
#pragma once

#include <string>

#include "formats/error.h"
#include "tools/common/json_output.h"

namespace deltaz {

std::string codeTable();
Json codeTableJson();

// Errors: kUsage for a code that does not exist.
Result<std::string> explainCode(const std::string& name);
Result<Json> explainCodeJson(const std::string& name);

}  // namespace deltaz
