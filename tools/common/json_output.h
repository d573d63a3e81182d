// JSON as the tools print it: members in the order they were set, every number finite or null, text always
// valid UTF-8.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>

namespace deltaz {

using Json = nlohmann::ordered_json;

// Every report of the tools begins with this number; it grows when a member changes its meaning or goes away.
inline constexpr int kOutputSchemaVersion = 1;

// {"schema_version": 1, "tool": TOOL, "tool_version": "0.1.0"}
Json jsonHeader(const std::string& tool);

// The number, or null where it is infinite or not a number.
Json finiteOrNull(double value);

// The value, or null where there is none.
template <typename T>
Json valueOrNull(const std::optional<T>& value) {
  return value ? Json(*value) : Json(nullptr);
}

// Indented, with a final newline. Bytes that are not UTF-8 (in file names) become U+FFFD.
std::string jsonText(const Json& json);

}  // namespace deltaz
