#include "libdb/check/check.h"

#include <exception>
#include <oneapi/tbb/task_arena.h>
#include <utility>

#include "libdb/access/database.h"
#include "libdb/check/check_context.h"
#include "libdb/check/report_detail.h"

namespace deltaz {
namespace {

void runRules(CheckContext& context) {
  if (!openDatabaseFiles(context)) return;
  checkFolder(context);
  checkTree(context);
  checkColorTrees(context);
  checkModelTrees(context);
  checkPlacementRecords(context);
  if (context.options.level >= CheckLevel::kChecksum) checkChecksums(context);
  if (context.options.level >= CheckLevel::kDecode) {
    checkTerrain(context);
    checkColorTiles(context);
    checkModelMeshes(context);
    checkPlacedModels(context);
  }
  if (context.options.level >= CheckLevel::kGeometry) {
    checkGeometry(context);
    checkModelErrors(context);
  }
  if (context.options.against != nullptr) checkAgainstSource(context);
}

}  // namespace

namespace {

// `generation` becomes that of the state that was checked, 0 if area.json could not be read.
Report checkOnce(const FileSystem& files, const std::string& path, const CheckOptions& options,
                 std::uint64_t& generation) {
  CheckContext context(files, path, options);
  // A rule that fails has proved nothing: the report says so and is never taken for a clean one.
  const auto failed = [&](const char* what) {
    context.report.complete = false;
    context.report.fatal = internalError(path, std::string("the check failed: ") + what);
  };
  try {
    // More threads than the machine has bring nothing but TBB's complaint on stderr.
    const int most = oneapi::tbb::info::default_concurrency();
    oneapi::tbb::task_arena arena(options.threads > 0 ? std::min(options.threads, most) : most);
    arena.execute([&] { runRules(context); });
  } catch (const std::exception& exception) {
    failed(exception.what());
  } catch (...) {
    failed("unknown exception");
  }
  generation = context.listed.empty() ? 0 : context.area.generation;
  return std::move(context.report);
}

// The generation that stands in area.json now; 0 if that cannot be told.
std::uint64_t currentGeneration(const FileSystem& files, const std::string& path) {
  try {
    const Result<Database> database = Database::open(files, path);
    return database.ok() ? database.value().area().generation : 0;
  } catch (const std::exception&) {
    return 0;
  }
}

}  // namespace

Report checkDatabase(const FileSystem& files, const std::string& path, const CheckOptions& options) {
  // A writer may replace the database under the check: then the new state is checked instead.
  constexpr int kAttempts = 5;
  for (int attempt = 1;; ++attempt) {
    std::uint64_t generation = 0;
    Report report = checkOnce(files, path, options, generation);
    const bool clean = report.complete && report.count(Severity::kError) == 0;
    if (clean || attempt == kAttempts || generation == 0) return report;
    if (const std::uint64_t now = currentGeneration(files, path); now == 0 || now == generation)
      return report;
  }
}

}  // namespace deltaz
