#include "tests/support/fault_file_system.h"

#include <utility>

namespace deltaz {
namespace {

Error fault(const std::string& path, const char* what, const char* why) {
  return accessError(path, what, why);
}

class FaultReadableFile final : public ReadableFile {
 public:
  FaultReadableFile(std::unique_ptr<ReadableFile> file, std::string path,
                    std::shared_ptr<FaultFileSystem::Plan> plan)
      : file_(std::move(file)), path_(std::move(path)), plan_(std::move(plan)) {}
  std::uint64_t size() const override { return file_->size(); }
  Status readAt(std::uint64_t offset, std::span<std::byte> out) const override {
    if (plan_->fails(path_)) return fault(path_, "cannot read", "Input/output error");
    return file_->readAt(offset, out);
  }

 private:
  std::unique_ptr<ReadableFile> file_;
  std::string path_;
  std::shared_ptr<FaultFileSystem::Plan> plan_;
};

class FaultWritableFile final : public WritableFile {
 public:
  FaultWritableFile(std::unique_ptr<WritableFile> file, std::string path,
                    std::shared_ptr<FaultFileSystem::Plan> plan)
      : file_(std::move(file)), path_(std::move(path)), plan_(std::move(plan)) {}
  Status append(std::span<const std::byte> bytes) override {
    if (!plan_->fails(path_)) return file_->append(bytes);
    DELTAZ_TRY(file_->append(bytes.first(bytes.size() / 2)));
    return fault(path_, "cannot write", "No space left on device");
  }
  Status sync() override {
    if (plan_->fails(path_)) return fault(path_, "cannot sync", "Input/output error");
    return file_->sync();
  }
  Status close() override {
    const Status closed = file_->close();
    if (plan_->fails(path_)) return fault(path_, "cannot close", "Input/output error");
    return closed;
  }

 private:
  std::unique_ptr<WritableFile> file_;
  std::string path_;
  std::shared_ptr<FaultFileSystem::Plan> plan_;
};

}  // namespace

bool FaultFileSystem::Plan::fails(const std::string& path) {
  const std::uint64_t number = ++operations;
  const bool fail =
      (!failing_path.empty() && path == failing_path) ||
      (failing != 0 && (number == failing || (mode == FaultMode::kFromThenOn && number > failing)));
  if (fail) failed = true;
  return fail;
}

FaultFileSystem::FaultFileSystem(const FileSystem& files, std::uint64_t failing, FaultMode mode)
    : files_(files), plan_(std::make_shared<Plan>()) {
  plan_->failing = failing;
  plan_->mode = mode;
}

FaultFileSystem::FaultFileSystem(const FileSystem& files, std::string failing_path)
    : files_(files), plan_(std::make_shared<Plan>()) {
  plan_->failing_path = std::move(failing_path);
}

Result<std::unique_ptr<ReadableFile>> FaultFileSystem::open(const std::string& path) const {
  if (plan_->fails(path)) return fault(path, "cannot open", "Input/output error");
  DELTAZ_TRY_ASSIGN(auto file, files_.open(path));
  return std::unique_ptr<ReadableFile>(std::make_unique<FaultReadableFile>(std::move(file), path, plan_));
}

Result<std::unique_ptr<WritableFile>> FaultFileSystem::create(const std::string& path) const {
  if (plan_->fails(path)) return fault(path, "cannot create", "No space left on device");
  DELTAZ_TRY_ASSIGN(auto file, files_.create(path));
  return std::unique_ptr<WritableFile>(std::make_unique<FaultWritableFile>(std::move(file), path, plan_));
}

Result<PathType> FaultFileSystem::typeOf(const std::string& path) const {
  if (plan_->fails(path)) return fault(path, "cannot look up", "Input/output error");
  return files_.typeOf(path);
}

Result<std::vector<std::string>> FaultFileSystem::list(const std::string& path) const {
  if (plan_->fails(path)) return fault(path, "cannot list", "Input/output error");
  return files_.list(path);
}

Status FaultFileSystem::makeDirectory(const std::string& path) const {
  if (plan_->fails(path)) return fault(path, "cannot create the folder", "No space left on device");
  return files_.makeDirectory(path);
}

Status FaultFileSystem::rename(const std::string& from, const std::string& to) const {
  if (plan_->fails(to)) return fault(to, "cannot rename", "Input/output error");
  return files_.rename(from, to);
}

Status FaultFileSystem::renameNoReplace(const std::string& from, const std::string& to) const {
  if (plan_->fails(to)) return fault(to, "cannot rename", "Input/output error");
  return files_.renameNoReplace(from, to);
}

Status FaultFileSystem::removeFile(const std::string& path) const {
  if (plan_->fails(path)) return fault(path, "cannot remove", "Input/output error");
  return files_.removeFile(path);
}

Status FaultFileSystem::removeDirectory(const std::string& path) const {
  if (plan_->fails(path)) return fault(path, "cannot remove", "Input/output error");
  return files_.removeDirectory(path);
}

Status FaultFileSystem::syncFile(const std::string& path) const {
  if (plan_->fails(path)) return fault(path, "cannot write to the disk", "Input/output error");
  return files_.syncFile(path);
}

Status FaultFileSystem::syncDirectory(const std::string& path) const {
  if (plan_->fails(path)) return fault(path, "cannot sync the folder", "Input/output error");
  return files_.syncDirectory(path);
}

Result<std::unique_ptr<FileLock>> FaultFileSystem::lock(const std::string& path) const {
  if (plan_->fails(path)) return fault(path, "cannot lock", "No locks available");
  return files_.lock(path);
}

}  // namespace deltaz
