#include "tools/common/command_line.h"

#include <algorithm>
#include <exception>
#include <iostream>
#include <new>

#include "tools/common/parse.h"

namespace deltaz {

namespace {

constexpr int kMaximumThreads = 1024;

// The subcommand the user was in, so that the hint names its help.
std::string commandPath(const CLI::App& app, const std::string& tool) {
  const auto chosen = app.get_subcommands();
  return chosen.empty() ? tool : tool + " " + chosen.front()->get_name();
}

}  // namespace

const char* toolVersion() {
  return DELTAZ_VERSION;
}

Result<int> CommonOptions::threads() const {
  if (threads_text.empty()) return 0;
  DELTAZ_TRY_ASSIGN(const std::int64_t count, parseInteger(threads_text, "-j", 1, kMaximumThreads));
  return static_cast<int>(count);
}

void addCommonOptions(CLI::App& app, CommonOptions& options, bool writes) {
  app.set_help_flag("-h,--help", "Print this help and exit");
  auto* quiet = app.add_flag("-q,--quiet", options.quiet, "Print errors only (warnings stay in --json)");
  app.add_flag("-v,--verbose", options.verbose, "Print more")->excludes(quiet);
  app.add_option("-j,--jobs", options.threads_text, "Number of threads (default: as many as the machine has)")
      ->type_name("N");
  app.add_option("--progress", options.progress, "Progress on stderr: auto, none or json")
      ->check(CLI::IsMember({"auto", "none", "json"}))
      ->type_name("MODE")
      ->capture_default_str();
  app.add_flag("--json", options.json, "Print data as JSON on stdout, and nothing else there");
  if (writes) app.add_flag("--overwrite", options.overwrite, "Replace what stands at the target");
}

CLI::Option* addPathOption(CLI::App& app, const std::string& name, std::string& value,
                           const std::string& help) {
  const auto is_name = [name](const std::string& text) -> std::string {
    if (text.empty()) return "the name is empty";
    if (text.size() > 1 && text[0] == '-')
      return "'" + text + "' is an option, not a name (write ./" + text + ")";
    return {};
  };
  return app.add_option(name, value, help)->check(CLI::Validator(is_name, "", "name"));
}

std::optional<int> parseCommandLine(CLI::App& app, const std::string& tool, int argc, char** argv) {
  app.set_version_flag("--version", tool + " " + toolVersion(), "Print the version and exit");
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& request) {
    // --help and --version; the text goes to stdout.
    app.exit(request, std::cout, std::cerr);
    std::cout.flush();
    return std::cout.good() ? kExitDone : kExitCannotAccess;
  } catch (const CLI::ParseError& error) {
    std::cerr << tool << ": error: " << error.what() << "\nSee '" << commandPath(app, tool) << " --help'.\n";
    return kExitUsage;
  }
  return std::nullopt;
}

void printError(const std::string& tool, const Error& error) {
  // One error, one line: what other libraries had to say may come with line breaks.
  std::string message = error.message();
  std::replace(message.begin(), message.end(), '\n', ' ');
  std::cerr << tool << ": error: " << message << '\n';
}

int runTool(const std::string& tool, const std::function<Result<int>()>& body) {
  try {
    const Result<int> result = body();
    if (!result.ok()) {
      std::cout.flush();
      printError(tool, result.error());
      return exitCode(result.error().kind);
    }
    std::cout.flush();
    if (!std::cout.good()) {
      printError(tool, accessError("standard output", "cannot write"));
      return kExitCannotAccess;
    }
    return result.value();
  } catch (const std::bad_alloc&) {
    printError(tool, internalError("memory", "there is not enough of it"));
  } catch (const std::exception& exception) {
    printError(tool, internalError("internal error", exception.what()));
  } catch (...) {
    printError(tool, internalError("internal error", "an exception of unknown type"));
  }
  return kExitInternal;
}

}  // namespace deltaz
