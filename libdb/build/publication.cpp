#include "libdb/build/publication.h"

#include <algorithm>
#include <charconv>
#include <fmt/format.h>
#include <span>
#include <unistd.h>

namespace deltaz {

namespace {

constexpr std::string_view kNewAreaName = ".area.json.new";

std::string temporaryPrefix(const std::string& target) {
  return fmt::format(".{}.tmp-", baseName(target));
}

Error targetExists(const std::string& target) {
  return usageError(target, "the target exists", {}, "Choose another name or give --overwrite");
}

Error notOurs(const std::string& target, const std::string& why) {
  return usageError(target, "the target exists and is not a deltaz database, so it is not overwritten", why,
                    "Choose another name");
}

// The area header of the database at `target`; an error if it is not one. A damaged header gives an empty
// one.
Result<AreaHeader> existingArea(const FileSystem& files, const std::string& target) {
  DELTAZ_TRY_ASSIGN(const PathType type, files.typeOf(target));
  if (type != PathType::kDirectory) return notOurs(target, "it is not a folder");
  const std::string path = joinPath(target, std::string(kAreaFileName));
  DELTAZ_TRY_ASSIGN(const PathType area_type, files.typeOf(path));
  if (area_type != PathType::kFile) return notOurs(target, "there is no area.json in it");
  DELTAZ_TRY_ASSIGN(const std::vector<std::byte> bytes, readWholeFile(files, path, kMaximumAreaBytes));
  std::string text(bytes.size(), '\0');
  std::transform(bytes.begin(), bytes.end(), text.begin(), [](std::byte b) { return static_cast<char>(b); });
  Result<AreaHeader> area = parseArea(text, path);
  if (area.ok()) return area;
  // A database that is damaged may be replaced; a folder that only looks like one, or a newer one, may not.
  if (area.error().kind == ErrorKind::kInvalid && area.error().code != IssueCode::kManSyntax)
    return AreaHeader{};
  return notOurs(target, area.error().what);
}

// The generation a file name of ours carries, "nodes-000012.dzn" -> 12; 0 for other names.
std::uint64_t generationOf(const std::string& name) {
  const bool ours = (name.starts_with("nodes-") && name.ends_with(".dzn")) ||
                    (name.starts_with("terrain-") && name.ends_with(".dzt")) ||
                    (name.starts_with("patches-") && name.ends_with(".dzp")) ||
                    (name.starts_with("seams-") && name.ends_with(".dzj")) ||
                    (name.starts_with("colors-") && name.ends_with(".dzc")) ||
                    (name.starts_with("model-") && name.ends_with(".dzm")) ||
                    (name.starts_with("placements-") && name.ends_with(".dzl"));
  if (!ours) return 0;
  const std::size_t dash = name.find('-');
  if (dash == std::string::npos) return 0;
  std::uint64_t generation = 0;
  std::from_chars(name.data() + dash + 1, name.data() + name.size(), generation);
  return generation;
}

// The names of the files it removed.
Result<std::vector<std::string>> removeUnlistedFiles(const FileSystem& files, const std::string& folder,
                                                     const AreaHeader& area) {
  DELTAZ_TRY_ASSIGN(const std::vector<std::string> names, files.list(folder));
  std::vector<std::string> removed;
  for (const std::string& name : names) {
    const bool listed = std::any_of(area.files.begin(), area.files.end(),
                                    [&](const FileReference& file) { return file.name == name; });
    if (listed || (generationOf(name) == 0 && name != kNewAreaName)) continue;
    DELTAZ_TRY(files.removeFile(joinPath(folder, name)));
    removed.push_back(name);
  }
  return removed;
}

// The header of a database that can be edited: a sound one.
Result<AreaHeader> soundArea(const FileSystem& files, const std::string& target) {
  const std::string path = joinPath(target, std::string(kAreaFileName));
  DELTAZ_TRY_ASSIGN(const PathType type, files.typeOf(path));
  if (type != PathType::kFile) {
    return invalidError(IssueCode::kManSyntax, target, "this is not a deltaz database",
                        "there is no area.json in it");
  }
  DELTAZ_TRY_ASSIGN(const std::vector<std::byte> bytes, readWholeFile(files, path, kMaximumAreaBytes));
  std::string text(bytes.size(), '\0');
  std::transform(bytes.begin(), bytes.end(), text.begin(), [](std::byte b) { return static_cast<char>(b); });
  return parseArea(text, path);
}

// Removes the temporary folders of builds that died: those whose lock nobody holds.
void sweepLeftOvers(const FileSystem& files, const std::string& parent, const std::string& prefix) {
  const Result<std::vector<std::string>> names = files.list(parent);
  if (!names.ok()) return;
  for (const std::string& name : names.value()) {
    if (!name.starts_with(prefix)) continue;
    const std::string folder = joinPath(parent, name);
    const Result<std::unique_ptr<FileLock>> lock = files.lock(joinPath(folder, std::string(kLockFileName)));
    if (lock.ok()) (void)files.removeDirectory(folder);
  }
}

}  // namespace

Status checkTarget(const FileSystem& files, const std::string& target, bool overwrite) {
  if (baseName(target).empty() || target.empty()) return usageError("-o", "the target has no name");
  DELTAZ_TRY_ASSIGN(const PathType type, files.typeOf(target));
  if (type != PathType::kAbsent) {
    if (!overwrite) return targetExists(target);
    if (const Result<AreaHeader> area = existingArea(files, target); !area.ok()) return area.error();
    return Success{};
  }
  DELTAZ_TRY_ASSIGN(const PathType parent_type, files.typeOf(parentPath(target)));
  if (parent_type != PathType::kDirectory) {
    return accessError(parentPath(target), "cannot write here", "there is no such folder", "Make it first");
  }
  return Success{};
}

Publication::Publication(Publication&& other) noexcept
    : files_(other.files_),
      target_(std::move(other.target_)),
      folder_(std::move(other.folder_)),
      replaces_(other.replaces_),
      edits_(other.edits_),
      area_(std::move(other.area_)),
      done_(std::exchange(other.done_, true)),
      made_folder_(other.made_folder_),
      generation_(other.generation_),
      new_names_(std::move(other.new_names_)),
      lock_(std::move(other.lock_)) {}

Publication::~Publication() {
  if (done_) return;
  // What cannot be removed now is swept by the next build.
  if (made_folder_) {
    (void)files_->removeDirectory(folder_);
  } else {
    for (const std::string& name : new_names_) (void)files_->removeFile(joinPath(folder_, name));
  }
}

Result<Publication> Publication::begin(const FileSystem& files, const std::string& target, bool overwrite) {
  DELTAZ_TRY(checkTarget(files, target, overwrite));
  Publication publication(files, target);
  DELTAZ_TRY_ASSIGN(const PathType type, files.typeOf(target));
  if (type == PathType::kAbsent) {
    DELTAZ_TRY(publication.beginNew());
  } else {
    DELTAZ_TRY(publication.beginOverwrite());
  }
  return publication;
}

Result<Publication> Publication::beginEdit(const FileSystem& files, const std::string& target) {
  // Before the lock, whose file would otherwise be made in any folder.
  if (const Result<AreaHeader> area = soundArea(files, target); !area.ok()) return area.error();
  Publication publication(files, target);
  DELTAZ_TRY(publication.beginOverwrite());
  DELTAZ_TRY_ASSIGN(publication.area_, soundArea(files, target));
  publication.edits_ = true;
  return publication;
}

Result<std::vector<std::string>> removeUnlisted(const FileSystem& files, const std::string& target) {
  DELTAZ_TRY_ASSIGN(const Publication publication, Publication::beginEdit(files, target));
  return removeUnlistedFiles(files, target, publication.area());
}

Status Publication::beginNew() {
  const std::string parent = parentPath(target_);
  const std::string prefix = temporaryPrefix(target_);
  sweepLeftOvers(*files_, parent, prefix);
  // Another thread may be building the same target, and another process may sweep our folder before it is
  // locked: then the next name is tried.
  constexpr int kAttempts = 100;
  constexpr int kRefusals = 3;
  int refused = 0;
  for (int attempt = 0; attempt < kAttempts; ++attempt) {
    folder_ = joinPath(parent, fmt::format("{}{}-{}", prefix, ::getpid(), attempt));
    DELTAZ_TRY_ASSIGN(const PathType type, files_->typeOf(folder_));
    if (type != PathType::kAbsent) continue;
    if (Status made = files_->makeDirectory(folder_); !made.ok()) {
      Error error = made.error();
      error.where = target_;  // the name that was asked for
      return error;
    }
    made_folder_ = true;
    const std::string lock_path = joinPath(folder_, std::string(kLockFileName));
    Result<std::unique_ptr<FileLock>> lock = files_->lock(lock_path);
    if (!lock.ok()) {
      // Swept, or a disk that is full; the second will say so again.
      (void)files_->removeDirectory(folder_);
      made_folder_ = false;
      if (++refused == kRefusals) return lock.error();
      continue;
    }
    lock_ = std::move(lock).value();
    DELTAZ_TRY_ASSIGN(const PathType lock_type, files_->typeOf(lock_path));
    if (lock_type == PathType::kFile) return Success{};
    made_folder_ = false;
  }
  return accessError(parent, "cannot make a folder to build in", "every name for it is taken");
}

Status Publication::beginOverwrite() {
  folder_ = target_;
  replaces_ = true;
  DELTAZ_TRY_ASSIGN(lock_, files_->lock(joinPath(folder_, std::string(kLockFileName))));
  // Looked at again under the lock: another writer may just have finished.
  DELTAZ_TRY_ASSIGN(const AreaHeader area, existingArea(*files_, target_));
  generation_ = area.generation;
  DELTAZ_TRY_ASSIGN(const std::vector<std::string> names, files_->list(folder_));
  for (const std::string& name : names) generation_ = std::max(generation_, generationOf(name));
  ++generation_;
  return Success{};
}

std::string Publication::newFilePath(const std::string& name) {
  new_names_.push_back(name);
  return joinPath(folder_, name);
}

Status Publication::writeArea(const std::string& name, const AreaHeader& area) {
  const std::string text = serializeArea(area);
  DELTAZ_TRY_ASSIGN(const std::unique_ptr<WritableFile> file, files_->create(newFilePath(name)));
  DELTAZ_TRY(file->append(std::as_bytes(std::span(text.data(), text.size()))));
  DELTAZ_TRY(file->sync());
  return file->close();
}

Status Publication::publish(AreaHeader& area) {
  area.generation = generation_;
  // Nothing is published that this version would refuse to open.
  if (const Result<AreaHeader> back = parseArea(serializeArea(area), target_); !back.ok()) {
    return internalError(target_, "the database would not be readable: " + back.error().message());
  }
  if (!replaces_) {
    DELTAZ_TRY(writeArea(std::string(kAreaFileName), area));
    DELTAZ_TRY(files_->syncDirectory(folder_));
    DELTAZ_TRY(files_->renameNoReplace(folder_, target_));
    done_ = true;
    return files_->syncDirectory(parentPath(target_));
  }
  const std::string fresh = joinPath(folder_, std::string(kNewAreaName));
  if (const Result<PathType> type = files_->typeOf(fresh); type.ok() && type.value() != PathType::kAbsent) {
    DELTAZ_TRY(files_->removeFile(fresh));  // of a writer that died
  }
  DELTAZ_TRY(writeArea(std::string(kNewAreaName), area));
  DELTAZ_TRY(files_->syncDirectory(folder_));
  DELTAZ_TRY(files_->rename(fresh, joinPath(folder_, std::string(kAreaFileName))));
  done_ = true;
  DELTAZ_TRY(files_->syncDirectory(folder_));
  // The files of older states, and of writers that died, serve nobody who opens from now on. Failing to
  // remove them loses nothing. An edit leaves them to removeUnlisted.
  if (!edits_) (void)removeUnlistedFiles(*files_, folder_, area);
  return Success{};
}

}  // namespace deltaz
