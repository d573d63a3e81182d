// One subcommand of dbbuild: its options, and what it does with them.
#pragma once

#include <memory>

#include "tools/common/command_line.h"

namespace deltaz {

class Command {
 public:
  virtual ~Command() = default;
  virtual CLI::App& app() = 0;
  // Pre: the command line was parsed and named this command.
  virtual Result<int> run() = 0;
};

// Each adds its subcommand to `parent`, which must outlive it.
std::unique_ptr<Command> makeTerrainCommand(CLI::App& parent);
std::unique_ptr<Command> makeModelCommand(CLI::App& parent);
std::unique_ptr<Command> makePlaceCommand(CLI::App& parent);
std::unique_ptr<Command> makeInfoCommand(CLI::App& parent);
std::unique_ptr<Command> makeExportCommand(CLI::App& parent);
std::unique_ptr<Command> makeRunCommand(CLI::App& parent);
std::unique_ptr<Command> makeColorCommand(CLI::App& parent);
std::unique_ptr<Command> makeGcCommand(CLI::App& parent);

}  // namespace deltaz
