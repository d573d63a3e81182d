// A file system in memory: of databases that a program makes for itself, and what tests damage, snapshot and
// watch. Behaves as formats/file_system.h promises,
// folders included. Copying one takes a snapshot; contents are shared until one side changes them, so a copy
// is cheap.
//
// Thread-safety: as FileSystem for everything the interface offers; the members for tests (bytes, setBytes,
// ...) may not run while another thread uses the same object.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <span>
#include <string>
#include <vector>

#include "formats/file_system.h"

namespace deltaz {

class MemoryFileSystem final : public FileSystem {
 public:
  using Bytes = std::vector<std::byte>;

  MemoryFileSystem();
  MemoryFileSystem(const MemoryFileSystem& other);
  MemoryFileSystem& operator=(const MemoryFileSystem& other);
  ~MemoryFileSystem() override;

  Result<std::unique_ptr<ReadableFile>> open(const std::string& path) const override;
  Result<std::unique_ptr<WritableFile>> create(const std::string& path) const override;
  Result<PathType> typeOf(const std::string& path) const override;
  Result<std::vector<std::string>> list(const std::string& path) const override;
  Status makeDirectory(const std::string& path) const override;
  Status rename(const std::string& from, const std::string& to) const override;
  Status renameNoReplace(const std::string& from, const std::string& to) const override;
  Status removeFile(const std::string& path) const override;
  Status removeDirectory(const std::string& path) const override;
  Status syncFile(const std::string& path) const override;
  Status syncDirectory(const std::string& path) const override;
  Result<std::unique_ptr<FileLock>> lock(const std::string& path) const override;

  // The contents of a file; throws std::out_of_range if there is none.
  const Bytes& bytes(const std::string& path) const;
  // The same to change in place. Files opened before keep what they had when they shared it with nobody else,
  // so change a file only while nobody reads it.
  Bytes& mutableBytes(const std::string& path);
  // Creates or replaces a file, and the folders above it.
  void setBytes(const std::string& path, Bytes contents);
  void setText(const std::string& path, const std::string& text);
  std::string text(const std::string& path) const;
  void flipBit(const std::string& path, std::uint64_t bit);
  // Paths of all files, sorted.
  std::vector<std::string> paths() const;
  // Paths of all folders, sorted, the root not counted.
  std::vector<std::string> folders() const;

 private:
  struct State;
  std::shared_ptr<State> state_;
};

}  // namespace deltaz
