// dbbuild: makes databases from DEMs, says what is in them, and gives the DEM back. See dbbuild(1).
#include <vector>

#include "tools/dbbuild/command.h"

int main(int argc, char** argv) {
  using namespace deltaz;
  return runTool("dbbuild", [&]() -> Result<int> {
    CLI::App app("Builds gaming-area terrain databases from DEMs, and gives the DEM back.", "dbbuild");
    app.set_help_flag("-h,--help", "Print this help and exit");
    // Not required here: CLI11 would then say so instead of naming an unknown one.
    app.require_subcommand(0, 1);
    app.footer(
        "Exit codes: 0 done; 1 content refused or damaged; 2 usage, target exists; 3 cannot read, write or "
        "lock;\n"
        "4 newer format; 70 internal error. See dbbuild(1).");
    std::vector<std::unique_ptr<Command>> commands;
    commands.push_back(makeTerrainCommand(app));
    commands.push_back(makeColorCommand(app));
    commands.push_back(makeModelCommand(app));
    commands.push_back(makePlaceCommand(app));
    commands.push_back(makeRunCommand(app));
    commands.push_back(makeInfoCommand(app));
    commands.push_back(makeExportCommand(app));
    commands.push_back(makeGcCommand(app));
    if (const auto code = parseCommandLine(app, "dbbuild", argc, argv)) return *code;
    for (const auto& command : commands) {
      if (command->app().parsed()) return command->run();
    }
    std::string names;
    for (const auto& command : commands) names += (names.empty() ? "" : ", ") + command->app().get_name();
    return usageError("command line", "a subcommand is required, one of " + names, {},
                      "See 'dbbuild --help'");
  });
}
