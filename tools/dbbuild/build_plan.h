// The build file of `dbbuild run`: what is said on the command lines of dbbuild's other commands, in one TOML
// file. A section is named after a command, its keys after that command's options, so there is one place
// where an option is defined and described.
//
// Strict: an unknown section or key, or a value of the wrong kind, is an error that names line, column and
// the nearest name there is. Errors: kUsage. Thread-safety: pure functions.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "formats/error.h"
#include "formats/file_system.h"

namespace deltaz {

enum class KeyKind : std::uint8_t {
  kFlag,   // true or false
  kValue,  // text or number; several numbers may stand in an array
  kList    // one value, or an array of them; numbers alone are one, as above
};

struct PlanKey {
  std::string name;  // as in the file: the option without its dashes, or a name for a positional argument
  KeyKind kind = KeyKind::kValue;
  bool is_path = false;  // relative to the build file's folder
  bool positional = false;
  bool required = false;
};

struct PlanSection {
  std::string name;       // of the command
  bool repeated = false;  // [[name]], any number of them; else [name], at most one
  bool required = false;
  std::vector<PlanKey> keys;
};

// A value as it goes to its command, and where it stands in the file.
struct PlanValue {
  std::string key, text;
  bool is_path = false;
  std::size_t line = 0, column = 0;
};

// One command to run.
struct PlanStep {
  std::string section;
  std::size_t line = 0;                  // of the section's heading
  std::vector<std::string> positionals;  // in the order of the section's keys
  std::vector<std::string> options;      // "--name=value", "--flag"
  std::vector<PlanValue> values;         // all of them but flags
};

struct BuildPlan {
  std::string area;             // the database to make
  std::vector<PlanStep> steps;  // sections in the order of the schema, each kind in the order of the file
};

// `where` is the build file's name for messages, `folder` what its paths are relative to.
Result<BuildPlan> parseBuildPlan(std::string_view text, const std::string& where, const std::string& folder,
                                 const std::vector<PlanSection>& schema);

// Names that steps give and other steps use.
struct PlanNames {
  std::string section, name_key;          // [[model]], name
  std::string used_by_section, used_key;  // [[place]], model; empty if none uses them
};
// What would fail at a later step and can be known before the first: a name that two steps give, a step that
// uses a name none gives, a file that is not there. What GDAL alone can find (/vsi..., DRIVER:...) is left to
// it.
Status checkPlan(const BuildPlan& plan, const std::string& where, const std::vector<PlanNames>& names,
                 const FileSystem& files);

}  // namespace deltaz
