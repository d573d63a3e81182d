#include "tools/common/output_file.h"

#include <cerrno>
#include <cstring>
#include <fmt/format.h>
#include <memory>
#include <unistd.h>

#include "formats/file_system.h"

namespace deltaz {

namespace {

std::string temporaryName(const std::string& path) {
  return joinPath(parentPath(path), fmt::format(".{}.tmp-{}", baseName(path), ::getpid()));
}

Status writeAndSync(const std::string& path, std::span<const std::byte> bytes) {
  DELTAZ_TRY_ASSIGN(const std::unique_ptr<WritableFile> file, localFileSystem().create(path));
  DELTAZ_TRY(file->append(bytes));
  DELTAZ_TRY(file->sync());
  return file->close();
}

// Of writing: about the file that was asked for, whose temporary name nobody knows.
Error aboutTarget(Error error, const std::string& path) {
  error.where = path;
  return error;
}

}  // namespace

Status checkOutput(const std::string& path, bool overwrite) {
  const FileSystem& files = localFileSystem();
  DELTAZ_TRY_ASSIGN(const PathType type, files.typeOf(path));
  if (type == PathType::kDirectory)
    return usageError(path, "the target is a folder", {}, "Choose another name");
  if (type == PathType::kOther)
    return usageError(path, "the target is not a regular file", {}, "Choose another name");
  if (type != PathType::kAbsent && !overwrite) {
    return usageError(path, "the target exists", {}, "Choose another name or give --overwrite");
  }
  const std::string folder = parentPath(path);
  DELTAZ_TRY_ASSIGN(const PathType folder_type, files.typeOf(folder));
  if (folder_type != PathType::kDirectory)
    return accessError(path, "cannot write", "there is no folder " + folder);
  if (::access(folder.c_str(), W_OK | X_OK) != 0)
    return accessError(path, "cannot write", std::strerror(errno));
  return Success{};
}

Status writeOutput(const std::string& path, std::span<const std::byte> bytes, bool overwrite) {
  const FileSystem& files = localFileSystem();
  DELTAZ_TRY(checkOutput(path, overwrite));
  const std::string temporary = temporaryName(path);
  // Of a process that had our number and died.
  if (const Result<PathType> type = files.typeOf(temporary); type.ok() && type.value() == PathType::kFile) {
    if (const Status removed = files.removeFile(temporary); !removed.ok())
      return aboutTarget(removed.error(), path);
  }
  Status status = writeAndSync(temporary, bytes);
  if (status.ok())
    status = overwrite ? files.rename(temporary, path) : files.renameNoReplace(temporary, path);
  if (!status.ok()) {
    // The first failure is the one to report; a temporary file that was never made cannot be removed either.
    ::unlink(temporary.c_str());
    return aboutTarget(status.error(), path);
  }
  return files.syncDirectory(parentPath(path));
}

Status writeOutput(const std::string& path, std::string_view text, bool overwrite) {
  return writeOutput(path, std::as_bytes(std::span(text)), overwrite);
}

}  // namespace deltaz
