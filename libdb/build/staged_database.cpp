#include "libdb/build/staged_database.h"

#include <charconv>
#include <fmt/format.h>
#include <unistd.h>
#include <utility>

#include "libdb/access/database.h"
#include "libdb/build/publication.h"

namespace deltaz {

namespace {

std::string stagePrefix(const std::string& target) {
  return fmt::format(".{}.run-", baseName(target));
}

void removeStage(const FileSystem& files, const std::string& folder, const std::string& target) {
  // What cannot be removed now is swept by the next run.
  (void)files.removeDirectory(joinPath(folder, baseName(target)));
  (void)files.removeDirectory(folder);
}

// Removes the folders of runs that died: those whose lock nobody holds.
void sweepStages(const FileSystem& files, const std::string& target) {
  const std::string parent = parentPath(target);
  const Result<std::vector<std::string>> names = files.list(parent);
  if (!names.ok()) return;
  for (const std::string& name : names.value()) {
    if (!name.starts_with(stagePrefix(target))) continue;
    const std::string folder = joinPath(parent, name);
    const Result<std::unique_ptr<FileLock>> lock = files.lock(joinPath(folder, std::string(kLockFileName)));
    if (!lock.ok()) continue;
    // A step that died in the folder may have left its own temporary one.
    if (const Result<std::vector<std::string>> inside = files.list(folder); inside.ok()) {
      for (const std::string& left : inside.value()) {
        if (left != kLockFileName) (void)files.removeDirectory(joinPath(folder, left));
      }
    }
    (void)files.removeDirectory(folder);
  }
}

// "colors-000002-000.dzc" with 10 added to its generation: "colors-000012-000.dzc".
std::string renumbered(const std::string& name, std::uint64_t add) {
  const std::size_t dash = name.find('-');
  if (dash == std::string::npos) return name;
  std::uint64_t generation = 0;
  const auto end = std::from_chars(name.data() + dash + 1, name.data() + name.size(), generation).ptr;
  return fmt::format("{}-{:06}{}", name.substr(0, dash), generation + add,
                     name.substr(static_cast<std::size_t>(end - name.data())));
}

}  // namespace

StagedDatabase::StagedDatabase(StagedDatabase&& other) noexcept
    : files_(other.files_),
      target_(std::move(other.target_)),
      overwrite_(other.overwrite_),
      folder_(std::exchange(other.folder_, {})),
      path_(std::move(other.path_)),
      lock_(std::move(other.lock_)) {}

StagedDatabase::~StagedDatabase() {
  if (!folder_.empty()) removeStage(*files_, folder_, target_);
}

Result<StagedDatabase> StagedDatabase::begin(const FileSystem& files, const std::string& target,
                                             bool overwrite) {
  DELTAZ_TRY(checkTarget(files, target, overwrite));
  sweepStages(files, target);
  StagedDatabase staged(files, target, overwrite);
  constexpr int kAttempts = 100;
  for (int attempt = 0; attempt < kAttempts; ++attempt) {
    const std::string folder =
        joinPath(parentPath(target), fmt::format("{}{}-{}", stagePrefix(target), ::getpid(), attempt));
    DELTAZ_TRY_ASSIGN(const PathType type, files.typeOf(folder));
    if (type != PathType::kAbsent) continue;
    DELTAZ_TRY(files.makeDirectory(folder));
    staged.folder_ = folder;
    DELTAZ_TRY_ASSIGN(staged.lock_, files.lock(joinPath(folder, std::string(kLockFileName))));
    staged.path_ = joinPath(folder, baseName(target));
    return staged;
  }
  return accessError(parentPath(target), "cannot make a folder to build in", "every name for it is taken");
}

Status StagedDatabase::publish() {
  // What one step made and a later one replaced.
  DELTAZ_TRY(removeUnlisted(*files_, path_));
  DELTAZ_TRY_ASSIGN(const PathType type, files_->typeOf(target_));
  if (type != PathType::kAbsent && overwrite_) {
    DELTAZ_TRY(moveInto());
  } else {
    DELTAZ_TRY(files_->renameNoReplace(path_, target_));
    DELTAZ_TRY(files_->syncDirectory(parentPath(target_)));
  }
  removeStage(*files_, std::exchange(folder_, {}), target_);
  return Success{};
}

Status StagedDatabase::moveInto() {
  AreaHeader area;
  {
    DELTAZ_TRY_ASSIGN(const Database database, Database::open(*files_, path_));
    area = database.area();
  }
  DELTAZ_TRY_ASSIGN(Publication publication, Publication::begin(*files_, target_, true));
  const std::uint64_t add = publication.generation() - 1;
  for (FileReference& file : area.files) {
    const std::string name = renumbered(file.name, add);
    DELTAZ_TRY(files_->rename(joinPath(path_, file.name), publication.newFilePath(name)));
    file.name = name;
  }
  return publication.publish(area);
}

}  // namespace deltaz
