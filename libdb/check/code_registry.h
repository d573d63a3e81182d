// What every issue code means: the one source of --list-codes, --explain and the man page's table.
#pragma once

#include <span>
#include <string_view>

#include "formats/issue_code.h"
#include "libdb/check/check.h"

namespace deltaz {

struct CodeDescription {
  IssueCode code;
  Severity severity;
  CheckLevel level;              // the level that finds it (kDecode for SRC_ codes)
  std::string_view title;        // one line
  std::string_view explanation;  // what it means and how it comes about
  std::string_view remedy;       // what to do
  std::string_view section;      // of the format documents
};

// In the order of the codes; every code once.
std::span<const CodeDescription> codeRegistry();
const CodeDescription& describe(IssueCode code);

}  // namespace deltaz
