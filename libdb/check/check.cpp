#include "libdb/check/check.h"

#include <exception>
#include <oneapi/tbb/task_arena.h>
#include <utility>

#include "libdb/check/check_context.h"
#include "libdb/check/report_detail.h"

namespace deltaz {
namespace {

void runRules(CheckContext& context) {
  if (!openDatabaseFiles(context)) return;
  checkFolder(context);
  checkTree(context);
  if (context.options.level >= CheckLevel::kChecksum) checkChecksums(context);
  if (context.options.level >= CheckLevel::kDecode) checkTerrain(context);
  if (context.options.against != nullptr) checkAgainstSource(context);
}

}  // namespace

namespace {

Report checkOnce(const FileSystem& files, const std::string& path, const CheckOptions& options) {
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
  return std::move(context.report);
}

}  // namespace

Report checkDatabase(const FileSystem& files, const std::string& path, const CheckOptions& options) {
  // A writer may replace the database under the check: then the new state is checked instead.
  constexpr int kAttempts = 5;
  const std::string area_path = joinPath(path, std::string(kAreaFileName));
  const auto area = [&]() -> Result<std::vector<std::byte>> {
    try {
      return readWholeFile(files, area_path, kMaximumAreaBytes);
    } catch (const std::exception& exception) {
      return internalError(area_path, exception.what());
    }
  };
  for (int attempt = 1;; ++attempt) {
    const Result<std::vector<std::byte>> before = area();
    Report report = checkOnce(files, path, options);
    if (attempt == kAttempts || !before.ok() || (report.complete && report.count(Severity::kError) == 0))
      return report;
    const Result<std::vector<std::byte>> after = area();
    if (!after.ok() || after.value() == before.value()) return report;
  }
}

}  // namespace deltaz
