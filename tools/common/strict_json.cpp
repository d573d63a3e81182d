#include "tools/common/strict_json.h"

#include <fmt/format.h>
#include <set>

#include "formats/near_names.h"

namespace deltaz {

Error StrictJson::bad(const std::string& where, const std::string& what, const std::string& why) const {
  return invalidError(IssueCode::kNone, where, what, why, remedy_);
}

Result<Json> StrictJson::parse(std::string_view text, const std::string& where) const {
  std::vector<std::set<std::string>> members;
  std::string twice;
  const auto look = [&](int, Json::parse_event_t event, Json& value) {
    if (event == Json::parse_event_t::object_start) {
      members.emplace_back();
    } else if (event == Json::parse_event_t::object_end) {
      members.pop_back();
    } else if (event == Json::parse_event_t::key && !members.back().insert(value.get<std::string>()).second) {
      twice = value.get<std::string>();
    }
    return true;
  };
  try {
    Json json = Json::parse(text, look);
    if (!twice.empty()) return bad(where, fmt::format("the member \"{}\" stands twice in one object", twice));
    return json;
  } catch (const Json::parse_error& error) {
    return bad(where, "this is no JSON", fmt::format("it makes no sense at byte {}", error.byte));
  } catch (const std::exception&) {
    return bad(where, "this is no JSON");
  }
}

Status StrictJson::checkMembers(const Json& json, const std::string& where,
                                const std::vector<std::string>& known) const {
  if (!json.is_object()) return bad(where, "this is no object", "it is " + std::string(json.type_name()));
  for (const auto& member : json.items()) {
    bool found = false;
    for (const std::string& name : known) found = found || name == member.key();
    if (!found)
      return bad(where, fmt::format("there is no member \"{}\"", member.key()),
                 nearNamesText(member.key(), known));
  }
  return Success{};
}

Result<std::string> StrictJson::textOf(const Json& json, const std::string& where, const char* member) const {
  if (!json.contains(member)) return bad(where, fmt::format("the member \"{}\" is missing", member));
  if (!json[member].is_string()) return bad(where, fmt::format("\"{}\" is no text", member));
  return json[member].get<std::string>();
}

}  // namespace deltaz
