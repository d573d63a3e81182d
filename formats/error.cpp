#include "formats/error.h"

#include <array>

namespace deltaz {

namespace {

struct CodeName {
  IssueCode code;
  std::string_view name;
};

constexpr std::array kCodeNames = {
#define DELTAZ_NAME(name, text) CodeName{IssueCode::name, text},
    DELTAZ_ISSUE_CODES(DELTAZ_NAME)
#undef DELTAZ_NAME
};

Error makeError(ErrorKind kind, IssueCode code, std::string where, std::string what, std::string why,
                std::string remedy) {
  return Error{kind, code, std::move(what), std::move(where), std::move(why), std::move(remedy)};
}

}  // namespace

std::string_view issueCodeName(IssueCode code) {
  for (const CodeName& entry : kCodeNames) {
    if (entry.code == code) return entry.name;
  }
  return "NONE";
}

std::optional<IssueCode> issueCodeFromName(std::string_view name) {
  for (const CodeName& entry : kCodeNames) {
    if (entry.name == name) return entry.code;
  }
  return std::nullopt;
}

int exitCode(ErrorKind kind) {
  switch (kind) {
    case ErrorKind::kInvalid:
      return 1;
    case ErrorKind::kUsage:
      return 2;
    case ErrorKind::kCannotAccess:
      return 3;
    case ErrorKind::kNewerFormat:
      return 4;
    case ErrorKind::kInternal:
      return 70;
  }
  return 70;
}

std::string Error::message() const {
  std::string text;
  if (!where.empty()) text += where + ": ";
  text += what;
  if (!why.empty()) text += ": " + why;
  if (!remedy.empty()) text += ". " + remedy;
  return text;
}

Error invalidError(IssueCode code, std::string where, std::string what, std::string why, std::string remedy) {
  return makeError(ErrorKind::kInvalid, code, std::move(where), std::move(what), std::move(why),
                   std::move(remedy));
}

Error usageError(std::string where, std::string what, std::string why, std::string remedy) {
  return makeError(ErrorKind::kUsage, IssueCode::kNone, std::move(where), std::move(what), std::move(why),
                   std::move(remedy));
}

Error accessError(std::string where, std::string what, std::string why, std::string remedy) {
  return makeError(ErrorKind::kCannotAccess, IssueCode::kIoCannotRead, std::move(where), std::move(what),
                   std::move(why), std::move(remedy));
}

Error newerFormatError(IssueCode code, std::string where, std::string what, std::string remedy) {
  return makeError(ErrorKind::kNewerFormat, code, std::move(where), std::move(what), {}, std::move(remedy));
}

Error internalError(std::string where, std::string what) {
  return makeError(ErrorKind::kInternal, IssueCode::kNone, std::move(where), std::move(what), {}, {});
}

}  // namespace deltaz
