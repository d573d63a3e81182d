// What every tool's command line has in common: the shared options, the exit codes and how errors are
// printed.
//
// Exit codes: 0 done or valid; 1 content refused; 2 usage; 3 cannot read, write or lock; 4 verdict unknown or
// newer format; 70 internal error. CLI11's own codes never get out.
#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <optional>
#include <string>

#include "formats/error.h"

namespace deltaz {

inline constexpr int kExitDone = 0;
inline constexpr int kExitInvalid = 1;
inline constexpr int kExitUsage = 2;
inline constexpr int kExitCannotAccess = 3;
inline constexpr int kExitUnknown = 4;
inline constexpr int kExitInternal = 70;

// The version of deltaz, "0.1.0".
const char* toolVersion();

// Options every tool and every subcommand has.
struct CommonOptions {
  bool quiet = false;
  bool verbose = false;
  bool json = false;
  bool overwrite = false;
  std::string threads_text;
  std::string progress = "auto";

  // The number after -j; 0 (as many as the machine has) where none was given.
  Result<int> threads() const;
};

// Adds -q -v -j --progress --json, and --overwrite where the command writes something.
void addCommonOptions(CLI::App& app, CommonOptions& options, bool writes);

// Adds an option that names a file or folder. A value that looks like an option ("-o --json") is refused: it
// is a forgotten name, and would otherwise become one.
CLI::Option* addPathOption(CLI::App& app, const std::string& name, std::string& value,
                           const std::string& help);

// Parses. Returns the exit code when the program is to end now: after --help and --version, or on a usage
// error, which is printed with the name of what was wrong.
std::optional<int> parseCommandLine(CLI::App& app, const std::string& tool, int argc, char** argv);

// Runs the body of a tool and turns what comes out into its exit code. An Error is printed as "TOOL: error:
// ..."; an exception that no edge caught is our mistake and ends with 70; output that could not be written
// with 3.
int runTool(const std::string& tool, const std::function<Result<int>()>& body);

// "TOOL: error: MESSAGE" on stderr.
void printError(const std::string& tool, const Error& error);

}  // namespace deltaz
