// The error every part of the import gives for content it does not take.
#pragma once

#include <string>
#include <utility>

#include "formats/error.h"

namespace deltaz {

inline Error refusedSource(const std::string& path, std::string what, std::string why = {},
                           std::string remedy = {}) {
  return invalidError(IssueCode::kNone, path, std::move(what), std::move(why), std::move(remedy));
}

}  // namespace deltaz
