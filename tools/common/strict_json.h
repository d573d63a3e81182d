// Reads JSON files people write: JSON's own rules and nothing more, no member twice (of which the parser
// would keep the last), no member that is not known. What is wrong is said with its place. Errors: kInvalid.
// Thread-safety: const members from any thread.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "formats/error.h"
#include "tools/common/json_output.h"

namespace deltaz {

class StrictJson {
 public:
  // `remedy` ends every message: where the form of the file is described.
  explicit StrictJson(std::string remedy) : remedy_(std::move(remedy)) {}

  Error bad(const std::string& where, const std::string& what, const std::string& why = {}) const;
  Result<Json> parse(std::string_view text, const std::string& where) const;
  // An object all of whose members are known; one that is not is told with the names that are near.
  Status checkMembers(const Json& json, const std::string& where,
                      const std::vector<std::string>& known) const;
  // The member's text; an error if it is missing or none.
  Result<std::string> textOf(const Json& json, const std::string& where, const char* member) const;

 private:
  std::string remedy_;
};

}  // namespace deltaz
