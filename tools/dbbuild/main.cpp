// dbbuild: makes databases from DEMs, says what is in them, and gives the DEM back. See dbbuild(1).
#include <array>

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
    const std::array<std::unique_ptr<Command>, 4> commands = {makeTerrainCommand(app), makeRunCommand(app),
                                                              makeInfoCommand(app), makeExportCommand(app)};
    if (const auto code = parseCommandLine(app, "dbbuild", argc, argv)) return *code;
    for (const auto& command : commands) {
      if (command->app().parsed()) return command->run();
    }
    return usageError("command line", "a subcommand is required: terrain, run, info or export", {},
                      "See 'dbbuild --help'");
  });
}
