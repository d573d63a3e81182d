// The one door to the disk. Everything deltaz reads or writes of a database goes through a FileSystem, so
// that tests can put one in memory, make it fail, or stop it half way. (Sources are read by GDAL through its
// own layer.)
//
// Errors: kCannotAccess with the system's own words; kUsage where a target exists. Thread-safety: a
// FileSystem and a ReadableFile may be used from several threads at once; a WritableFile from one.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "formats/error.h"

namespace deltaz {

class ReadableFile {
 public:
  virtual ~ReadableFile() = default;
  // Length in bytes when the file was opened.
  virtual std::uint64_t size() const = 0;
  // Fills `out` from byte `offset` on. Reading past the end is an error, never a short read.
  virtual Status readAt(std::uint64_t offset, std::span<std::byte> out) const = 0;
};

class WritableFile {
 public:
  virtual ~WritableFile() = default;
  virtual Status append(std::span<const std::byte> bytes) = 0;
  // Returns once the bytes are on the disk.
  virtual Status sync() = 0;
  // Must be called once; the destructor closes too but cannot report what failed.
  virtual Status close() = 0;
};

// Held while it lives; released by destruction or by the end of the process.
class FileLock {
 public:
  virtual ~FileLock() = default;
};

enum class PathType : std::uint8_t { kAbsent, kFile, kDirectory, kOther };

class FileSystem {
 public:
  virtual ~FileSystem() = default;
  virtual Result<std::unique_ptr<ReadableFile>> open(const std::string& path) const = 0;
  // Creates a new file; an existing one is an error.
  virtual Result<std::unique_ptr<WritableFile>> create(const std::string& path) const = 0;
  virtual Result<PathType> typeOf(const std::string& path) const = 0;
  // Names (not paths) of what is in a folder, sorted.
  virtual Result<std::vector<std::string>> list(const std::string& path) const = 0;
  virtual Status makeDirectory(const std::string& path) const = 0;
  // Atomically replaces `to` if it is there.
  virtual Status rename(const std::string& from, const std::string& to) const = 0;
  // Atomically moves `from` to `to`; kUsage if `to` is there already.
  virtual Status renameNoReplace(const std::string& from, const std::string& to) const = 0;
  virtual Status removeFile(const std::string& path) const = 0;
  // Removes a folder and the files in it (not folders inside it).
  virtual Status removeDirectory(const std::string& path) const = 0;
  // Returns once the bytes of a file written by somebody else (GDAL) are on the disk.
  virtual Status syncFile(const std::string& path) const = 0;
  // Makes the names in a folder durable.
  virtual Status syncDirectory(const std::string& path) const = 0;
  // Takes the writers' lock on `path`, creating the file; fails at once with kCannotAccess if another process
  // has it.
  virtual Result<std::unique_ptr<FileLock>> lock(const std::string& path) const = 0;
};

// The machine's own file system. Lives as long as the program.
const FileSystem& localFileSystem();

// "folder/name"; `folder` may end in a slash.
std::string joinPath(const std::string& folder, const std::string& name);
// The last component: "c" for "a/b/c" and "a/b/c/".
std::string baseName(const std::string& path);
// What stands before the last component: "a/b" for "a/b/c"; "." when there is none.
std::string parentPath(const std::string& path);

// Reads a whole file of at most `limit` bytes.
Result<std::vector<std::byte>> readWholeFile(const FileSystem& files, const std::string& path,
                                             std::uint64_t limit);

}  // namespace deltaz
