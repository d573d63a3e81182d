#include "formats/file_system.h"

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <dirent.h>
#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

namespace deltaz {

namespace {

// The system's words for `error_number`, and what a person can do about the usual ones.
Error systemError(const std::string& where, const std::string& what, int error_number) {
  std::string remedy;
  if (error_number == ENOSPC || error_number == EDQUOT) remedy = "Free some space and run again";
  if (error_number == EACCES || error_number == EPERM) remedy = "Check the permissions";
  return accessError(where, what, std::strerror(error_number), remedy);
}

// A file descriptor that closes itself.
class Descriptor {
 public:
  explicit Descriptor(int value) : value_(value) {}
  Descriptor(Descriptor&& other) noexcept : value_(std::exchange(other.value_, -1)) {}
  Descriptor& operator=(Descriptor&&) = delete;
  ~Descriptor() {
    if (value_ >= 0) ::close(value_);
  }
  int get() const { return value_; }
  int release() { return std::exchange(value_, -1); }

 private:
  int value_;
};

class LocalReadableFile final : public ReadableFile {
 public:
  LocalReadableFile(Descriptor descriptor, std::string path, std::uint64_t size)
      : descriptor_(std::move(descriptor)), path_(std::move(path)), size_(size) {}

  std::uint64_t size() const override { return size_; }

  Status readAt(std::uint64_t offset, std::span<std::byte> out) const override {
    std::size_t done = 0;
    while (done < out.size()) {
      const ssize_t count =
          ::pread(descriptor_.get(), out.data() + done, out.size() - done, static_cast<off_t>(offset + done));
      if (count < 0) {
        if (errno == EINTR) continue;
        return systemError(path_, "cannot read", errno);
      }
      if (count == 0)
        return accessError(path_, "cannot read", "the file ends early", "It may have been cut while open");
      done += static_cast<std::size_t>(count);
    }
    return Success{};
  }

 private:
  Descriptor descriptor_;
  std::string path_;
  std::uint64_t size_;
};

class LocalWritableFile final : public WritableFile {
 public:
  LocalWritableFile(Descriptor descriptor, std::string path)
      : descriptor_(std::move(descriptor)), path_(std::move(path)) {}

  Status append(std::span<const std::byte> bytes) override {
    std::size_t done = 0;
    while (done < bytes.size()) {
      const ssize_t count = ::write(descriptor_.get(), bytes.data() + done, bytes.size() - done);
      if (count < 0) {
        if (errno == EINTR) continue;
        return systemError(path_, "cannot write", errno);
      }
      done += static_cast<std::size_t>(count);
    }
    return Success{};
  }

  Status sync() override {
    if (::fsync(descriptor_.get()) != 0) return systemError(path_, "cannot write to the disk", errno);
    return Success{};
  }

  Status close() override {
    if (::close(descriptor_.release()) != 0) return systemError(path_, "cannot close", errno);
    return Success{};
  }

 private:
  Descriptor descriptor_;
  std::string path_;
};

class LocalFileLock final : public FileLock {
 public:
  explicit LocalFileLock(Descriptor descriptor) : descriptor_(std::move(descriptor)) {}

 private:
  Descriptor descriptor_;
};

class LocalFileSystem final : public FileSystem {
 public:
  Result<std::unique_ptr<ReadableFile>> open(const std::string& path) const override {
    Descriptor descriptor(::open(path.c_str(), O_RDONLY | O_CLOEXEC));
    if (descriptor.get() < 0) return systemError(path, "cannot open", errno);
    struct stat status {};
    if (::fstat(descriptor.get(), &status) != 0) return systemError(path, "cannot open", errno);
    if (!S_ISREG(status.st_mode)) return accessError(path, "cannot open", "not a regular file");
    return std::unique_ptr<ReadableFile>(
        new LocalReadableFile(std::move(descriptor), path, static_cast<std::uint64_t>(status.st_size)));
  }

  Result<std::unique_ptr<WritableFile>> create(const std::string& path) const override {
    Descriptor descriptor(::open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666));
    if (descriptor.get() < 0) return systemError(path, "cannot create", errno);
    return std::unique_ptr<WritableFile>(new LocalWritableFile(std::move(descriptor), path));
  }

  Result<PathType> typeOf(const std::string& path) const override {
    struct stat status {};
    if (::lstat(path.c_str(), &status) != 0) {
      if (errno == ENOENT || errno == ENOTDIR) return PathType::kAbsent;
      return systemError(path, "cannot look at", errno);
    }
    // A link stands for what it points at; a dangling one is still something in the way.
    if (S_ISLNK(status.st_mode) && ::stat(path.c_str(), &status) != 0) return PathType::kOther;
    if (S_ISREG(status.st_mode)) return PathType::kFile;
    if (S_ISDIR(status.st_mode)) return PathType::kDirectory;
    return PathType::kOther;
  }

  Result<std::vector<std::string>> list(const std::string& path) const override {
    DIR* directory = ::opendir(path.c_str());
    if (directory == nullptr) return systemError(path, "cannot list", errno);
    std::vector<std::string> names;
    for (const dirent* entry = ::readdir(directory); entry != nullptr; entry = ::readdir(directory)) {
      const std::string name = entry->d_name;
      if (name != "." && name != "..") names.push_back(name);
    }
    ::closedir(directory);
    std::sort(names.begin(), names.end());
    return names;
  }

  Status makeDirectory(const std::string& path) const override {
    if (::mkdir(path.c_str(), 0777) != 0) return systemError(path, "cannot make the folder", errno);
    return Success{};
  }

  Status rename(const std::string& from, const std::string& to) const override {
    if (::rename(from.c_str(), to.c_str()) != 0) return systemError(to, "cannot put in place", errno);
    return Success{};
  }

  Status renameNoReplace(const std::string& from, const std::string& to) const override {
    if (::renameat2(AT_FDCWD, from.c_str(), AT_FDCWD, to.c_str(), RENAME_NOREPLACE) == 0) return Success{};
    if (errno == EEXIST || errno == ENOTEMPTY) {
      return usageError(to, "the target exists", {}, "Choose another name or give --overwrite");
    }
    return systemError(to, "cannot put in place", errno);
  }

  Status removeFile(const std::string& path) const override {
    if (::unlink(path.c_str()) != 0) return systemError(path, "cannot remove", errno);
    return Success{};
  }

  Status removeDirectory(const std::string& path) const override {
    DELTAZ_TRY_ASSIGN(const std::vector<std::string> names, list(path));
    for (const std::string& name : names) DELTAZ_TRY(removeFile(joinPath(path, name)));
    if (::rmdir(path.c_str()) != 0) return systemError(path, "cannot remove the folder", errno);
    return Success{};
  }

  Status syncFile(const std::string& path) const override {
    const Descriptor descriptor(::open(path.c_str(), O_RDONLY | O_CLOEXEC));
    if (descriptor.get() < 0) return systemError(path, "cannot open", errno);
    if (::fsync(descriptor.get()) != 0) return systemError(path, "cannot write to the disk", errno);
    return Success{};
  }

  Status syncDirectory(const std::string& path) const override {
    Descriptor descriptor(::open(path.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
    if (descriptor.get() < 0) return systemError(path, "cannot open the folder", errno);
    // Some file systems cannot sync a folder; that is no failure of ours.
    if (::fsync(descriptor.get()) != 0 && errno != EINVAL && errno != ENOTSUP) {
      return systemError(path, "cannot write the folder to the disk", errno);
    }
    return Success{};
  }

  Result<std::unique_ptr<FileLock>> lock(const std::string& path) const override {
    Descriptor descriptor(::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666));
    if (descriptor.get() < 0) return systemError(path, "cannot lock", errno);
    if (::flock(descriptor.get(), LOCK_EX | LOCK_NB) != 0) {
      if (errno == EWOULDBLOCK) {
        return accessError(path, "cannot lock", "another process is writing",
                           "Wait for it to end and run again");
      }
      return systemError(path, "cannot lock", errno);
    }
    return std::unique_ptr<FileLock>(new LocalFileLock(std::move(descriptor)));
  }
};

}  // namespace

const FileSystem& localFileSystem() {
  static const LocalFileSystem instance;
  return instance;
}

namespace {

std::string withoutTrailingSlashes(std::string path) {
  while (path.size() > 1 && path.back() == '/') path.pop_back();
  return path;
}

}  // namespace

std::string joinPath(const std::string& folder, const std::string& name) {
  if (folder.empty()) return name;
  return folder.back() == '/' ? folder + name : folder + '/' + name;
}

std::string baseName(const std::string& path) {
  const std::string trimmed = withoutTrailingSlashes(path);
  const std::size_t slash = trimmed.rfind('/');
  return slash == std::string::npos || trimmed.size() == 1 ? trimmed : trimmed.substr(slash + 1);
}

std::string parentPath(const std::string& path) {
  const std::string trimmed = withoutTrailingSlashes(path);
  const std::size_t slash = trimmed.rfind('/');
  if (slash == std::string::npos) return ".";
  return slash == 0 ? "/" : withoutTrailingSlashes(trimmed.substr(0, slash));
}

Result<std::vector<std::byte>> readWholeFile(const FileSystem& files, const std::string& path,
                                             std::uint64_t limit) {
  DELTAZ_TRY_ASSIGN(const std::unique_ptr<ReadableFile> file, files.open(path));
  if (file->size() > limit) {
    return invalidError(IssueCode::kHdrLength, path, "the file is too long to be what its name says");
  }
  std::vector<std::byte> bytes(file->size());
  DELTAZ_TRY(file->readAt(0, bytes));
  return bytes;
}

}  // namespace deltaz
