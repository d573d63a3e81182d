#include "tools/common/json_output.h"

#include <cmath>

#include "tools/common/command_line.h"

namespace deltaz {

Json jsonHeader(const std::string& tool) {
  Json json;
  json["schema_version"] = kOutputSchemaVersion;
  json["tool"] = tool;
  json["tool_version"] = toolVersion();
  return json;
}

Json finiteOrNull(double value) {
  return std::isfinite(value) ? Json(value) : Json(nullptr);
}

std::string jsonText(const Json& json) {
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace deltaz
