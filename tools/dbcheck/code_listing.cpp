#include "tools/dbcheck/code_listing.h"

#include <fmt/format.h>

#include "libdb/check/code_registry.h"
#include "tools/dbcheck/verdict.h"

namespace deltaz {

namespace {

Json codeJson(const CodeDescription& code) {
  Json json;
  json["code"] = issueCodeName(code.code);
  json["severity"] = severityName(code.severity);
  json["level"] = levelName(code.level);
  json["title"] = code.title;
  json["explanation"] = code.explanation;
  json["remedy"] = code.remedy;
  json["section"] = code.section;
  return json;
}

Result<const CodeDescription*> find(const std::string& name) {
  const std::optional<IssueCode> code = issueCodeFromName(name);
  if (!code || *code == IssueCode::kNone) {
    return usageError("--explain", "there is no code '" + name + "'", {}, "--list-codes lists them");
  }
  return &describe(*code);
}

}  // namespace

std::string codeTable() {
  std::string text;
  for (const CodeDescription& code : codeRegistry()) {
    text += fmt::format("{:22} {:11} {:9} {}\n", issueCodeName(code.code), severityName(code.severity),
                        levelName(code.level), code.title);
  }
  return text;
}

Json codeTableJson() {
  Json json = jsonHeader("dbcheck");
  json["codes"] = Json::array();
  for (const CodeDescription& code : codeRegistry()) json["codes"].push_back(codeJson(code));
  return json;
}

Result<std::string> explainCode(const std::string& name) {
  DELTAZ_TRY_ASSIGN(const CodeDescription* code, find(name));
  return fmt::format("{}: {}\n\n{}\n\nWhat to do: {}\nSeverity: {}; found at level {}; see {}\n",
                     issueCodeName(code->code), code->title, code->explanation, code->remedy,
                     severityName(code->severity), levelName(code->level), code->section);
}

Result<Json> explainCodeJson(const std::string& name) {
  DELTAZ_TRY_ASSIGN(const CodeDescription* code, find(name));
  Json json = jsonHeader("dbcheck");
  json.update(codeJson(*code));
  return json;
}

}  // namespace deltaz
