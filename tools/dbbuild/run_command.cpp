// dbbuild run: a whole database from one build file. Every section is run as the command it is named after,
// on a database in a temporary folder; the target appears when all of them are done.
#include <algorithm>
#include <fmt/format.h>
#include <iostream>
#include <sstream>

#include "libdb/build/staged_database.h"
#include "tools/common/json_output.h"
#include "tools/dbbuild/build_plan.h"
#include "tools/dbbuild/command.h"

namespace deltaz {

namespace {

constexpr std::uint64_t kLongestBuildFile = 16u << 20;

using MakeCommand = std::unique_ptr<Command> (*)(CLI::App&);

// A command as a section of a build file.
struct SectionSource {
  const char* name;
  MakeCommand make;
  bool repeated;
  std::vector<PlanKey> positionals;  // behind the database's own
  std::vector<std::string> path_options;
  std::vector<std::string> left_out;  // options that make no sense in a new database
};

const std::vector<SectionSource>& sectionSources() {
  static const std::vector<SectionSource> sources = {
      {"terrain", makeTerrainCommand, false, {{"sources", KeyKind::kList, true, true, true}}, {}, {}},
      {"color", makeColorCommand, true, {}, {"image", "ramp", "classes", "legend"}, {"remove"}},
      {"model", makeModelCommand, true, {{"mesh", KeyKind::kList, true, true, true}}, {}, {"remove"}},
      {"place",
       makePlaceCommand,
       true,
       {{"model", KeyKind::kValue, false, true, true}},
       {"from"},
       {"remove"}},
  };
  return sources;
}

// What every command has, and what the run says itself.
bool isOfTheRun(const std::string& option) {
  for (const char* name :
       {"help", "quiet", "verbose", "threads", "progress", "json", "overwrite", "output"}) {
    if (option == name) return true;
  }
  return false;
}

bool contains(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

// The keys follow from the command's own options, so that there is nothing to keep in step.
PlanSection sectionOf(const SectionSource& source) {
  CLI::App parent;
  const std::unique_ptr<Command> command = source.make(parent);
  PlanSection section{source.name, source.repeated, !source.repeated, source.positionals};
  for (const CLI::Option* option : command->app().get_options()) {
    if (option->get_lnames().empty()) continue;
    const std::string& name = option->get_lnames().front();
    if (isOfTheRun(name) || contains(source.left_out, name)) continue;
    const KeyKind kind = option->get_expected_max() == 0  ? KeyKind::kFlag
                         : option->get_expected_max() > 1 ? KeyKind::kList
                                                          : KeyKind::kValue;
    section.keys.push_back({name, kind, contains(source.path_options, name)});
  }
  return section;
}

// Holds back what is written to standard output while it lives.
class CapturedOutput {
 public:
  CapturedOutput() : before_(std::cout.rdbuf(text_.rdbuf())) {}
  ~CapturedOutput() { std::cout.rdbuf(before_); }
  CapturedOutput(const CapturedOutput&) = delete;
  CapturedOutput& operator=(const CapturedOutput&) = delete;
  std::string text() const { return text_.str(); }

 private:
  std::ostringstream text_;
  std::streambuf* before_;
};

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  for (std::size_t at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size()))
    text.replace(at, from.size(), to);
  return text;
}

class RunCommand final : public Command {
 public:
  explicit RunCommand(CLI::App& parent)
      : app_(*parent.add_subcommand("run", "Build a whole database from one build file")) {
    addPathOption(app_, "BUILD.toml", file_, "The build file: terrain, colour maps, models and placements")
        ->required();
    addCommonOptions(app_, common_, true);
  }

  CLI::App& app() override { return app_; }

  Result<int> run() override {
    DELTAZ_TRY(common_.threads());
    DELTAZ_TRY_ASSIGN(const std::vector<std::byte> bytes,
                      readWholeFile(localFileSystem(), file_, kLongestBuildFile));
    std::string text(bytes.size(), '\0');
    std::transform(bytes.begin(), bytes.end(), text.begin(),
                   [](std::byte b) { return static_cast<char>(b); });
    std::vector<PlanSection> schema;
    for (const SectionSource& source : sectionSources()) schema.push_back(sectionOf(source));
    DELTAZ_TRY_ASSIGN(const BuildPlan plan, parseBuildPlan(text, file_, parentPath(file_), schema));

    DELTAZ_TRY(checkPlan(plan, file_, {{"color", "name", "", ""}, {"model", "name", "place", "model"}},
                         localFileSystem()));
    DELTAZ_TRY_ASSIGN(StagedDatabase staged,
                      StagedDatabase::begin(localFileSystem(), plan.area, common_.overwrite));
    Json reports = Json::array();
    for (const PlanStep& step : plan.steps) {
      std::string output;
      DELTAZ_TRY_ASSIGN(const int code, runStep(step, plan, staged.path(), output));
      if (code != kExitDone) return code;
      if (common_.json) {
        reports.push_back({{"command", step.section}, {"report", Json::parse(output, nullptr, false)}});
      } else {
        std::cout << output << std::flush;
      }
    }
    DELTAZ_TRY(staged.publish());
    if (common_.json) {
      Json json = jsonHeader("dbbuild");
      json["area"] = plan.area;
      json["steps"] = reports;
      std::cout << jsonText(json);
    }
    return kExitDone;
  }

 private:
  std::vector<std::string> argumentsOf(const PlanStep& step, const std::string& database) const {
    std::vector<std::string> arguments = {step.section};
    const bool makes = step.section == "terrain";
    if (!makes) arguments.push_back(database);
    arguments.insert(arguments.end(), step.positionals.begin(), step.positionals.end());
    if (makes) arguments.insert(arguments.end(), {"-o", database});
    arguments.insert(arguments.end(), step.options.begin(), step.options.end());
    if (common_.quiet) arguments.emplace_back("-q");
    if (common_.verbose) arguments.emplace_back("-v");
    if (common_.json) arguments.emplace_back("--json");
    if (!common_.threads_text.empty()) arguments.insert(arguments.end(), {"-j", common_.threads_text});
    arguments.insert(arguments.end(), {"--progress", common_.progress});
    return arguments;
  }

  Result<int> runStep(const PlanStep& step, const BuildPlan& plan, const std::string& database,
                      std::string& output) const {
    const std::string place = fmt::format("{}, line {}, {}", file_, step.line, step.section);
    const auto at_place = [&](Error error) {
      error.where = place + ": " + error.where;
      for (std::string* text : {&error.what, &error.where, &error.why, &error.remedy})
        *text = replaced(*text, database, plan.area);
      return error;
    };
    CLI::App parent;
    std::unique_ptr<Command> command;
    for (const SectionSource& source : sectionSources()) {
      if (step.section == source.name) command = source.make(parent);
    }
    std::vector<std::string> arguments = argumentsOf(step, database);
    std::reverse(arguments.begin(), arguments.end());  // as CLI11 takes them
    try {
      parent.parse(arguments);
    } catch (const CLI::ParseError& error) {
      return usageError(place, error.what());
    }
    const CapturedOutput captured;
    Result<int> code = command->run();
    output = replaced(captured.text(), database, plan.area);
    if (!code.ok()) return at_place(code.error());
    return code;
  }

  CLI::App& app_;
  CommonOptions common_;
  std::string file_;
};

}  // namespace

std::unique_ptr<Command> makeRunCommand(CLI::App& parent) {
  return std::make_unique<RunCommand>(parent);
}

}  // namespace deltaz
