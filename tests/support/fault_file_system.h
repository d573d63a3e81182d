// A file system that stands before another one, counts operations and makes the n-th one fail, once or from
// then on. Every call of the interface counts, those of open files included; an append that fails writes the
// first half, as a full disk does.
//
// Thread-safety: as FileSystem. With several threads the order of operations, and so which one fails, may
// vary.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <string>

#include "formats/file_system.h"

namespace deltaz {

enum class FaultMode : std::uint8_t { kOnce, kFromThenOn };

class FaultFileSystem final : public FileSystem {
 public:
  // Operation number `failing` (counted from 1) fails; 0: none, only count.
  FaultFileSystem(const FileSystem& files, std::uint64_t failing, FaultMode mode = FaultMode::kOnce);

  // Every operation on the file `failing_path`, and only those, fail.
  FaultFileSystem(const FileSystem& files, std::string failing_path);

  // Operations so far.
  std::uint64_t operations() const { return plan_->operations; }
  // Whether an operation was made to fail.
  bool failed() const { return plan_->failed; }

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

  struct Plan {
    std::uint64_t failing = 0;
    FaultMode mode = FaultMode::kOnce;
    std::atomic<std::uint64_t> operations = 0;
    std::atomic<bool> failed = false;
    std::string failing_path;
    // Counts one operation on `path`; true if it is to fail.
    bool fails(const std::string& path);
  };

 private:
  const FileSystem& files_;
  std::shared_ptr<Plan> plan_;
};

}  // namespace deltaz
