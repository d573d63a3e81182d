#include "formats/memory_file_system.h"

#include <algorithm>
#include <functional>
#include <set>
#include <stdexcept>
#include <utility>

namespace deltaz {

struct MemoryFileSystem::State {
  mutable std::mutex mutex;
  std::map<std::string, std::shared_ptr<Bytes>> files;
  std::set<std::string> folders;
  std::set<std::string> locks;
};

namespace {

using Bytes = MemoryFileSystem::Bytes;

// One spelling for each path: no "./" in front, no slash at the end; "" is the root and the working
// directory.
std::string normalized(std::string path) {
  while (path.starts_with("./")) path.erase(0, 2);
  while (!path.empty() && path.back() == '/') path.pop_back();
  return path == "." ? std::string() : path;
}

std::string parentOf(const std::string& path) {
  const auto slash = path.rfind('/');
  return slash == std::string::npos ? std::string() : path.substr(0, slash);
}

Error absent(const std::string& path) {
  return accessError(path, "cannot open", "No such file or directory");
}

class MemoryReadableFile final : public ReadableFile {
 public:
  MemoryReadableFile(std::string path, std::shared_ptr<const Bytes> contents)
      : path_(std::move(path)), contents_(std::move(contents)), size_(contents_->size()) {}
  std::uint64_t size() const override { return size_; }
  Status readAt(std::uint64_t offset, std::span<std::byte> out) const override {
    if (offset > contents_->size() || out.size() > contents_->size() - offset) {
      return accessError(path_, "cannot read", "read past the end of the file");
    }
    const auto begin = contents_->begin() + static_cast<std::ptrdiff_t>(offset);
    std::copy(begin, begin + static_cast<std::ptrdiff_t>(out.size()), out.begin());
    return Success{};
  }

 private:
  std::string path_;
  std::shared_ptr<const Bytes> contents_;
  std::uint64_t size_;
};

class MemoryWritableFile final : public WritableFile {
 public:
  explicit MemoryWritableFile(std::shared_ptr<Bytes> contents) : contents_(std::move(contents)) {}
  Status append(std::span<const std::byte> bytes) override {
    contents_->insert(contents_->end(), bytes.begin(), bytes.end());
    return Success{};
  }
  Status sync() override { return Success{}; }
  Status close() override { return Success{}; }

 private:
  std::shared_ptr<Bytes> contents_;
};

class MemoryLock final : public FileLock {
 public:
  explicit MemoryLock(std::function<void()> release) : release_(std::move(release)) {}
  ~MemoryLock() override { release_(); }

 private:
  std::function<void()> release_;
};

}  // namespace

MemoryFileSystem::MemoryFileSystem() : state_(std::make_shared<State>()) {}
MemoryFileSystem::~MemoryFileSystem() = default;

MemoryFileSystem::MemoryFileSystem(const MemoryFileSystem& other) : state_(std::make_shared<State>()) {
  const std::lock_guard guard(other.state_->mutex);
  state_->files = other.state_->files;
  state_->folders = other.state_->folders;
}

MemoryFileSystem& MemoryFileSystem::operator=(const MemoryFileSystem& other) {
  if (this != &other) {
    MemoryFileSystem copy(other);
    std::swap(state_, copy.state_);
  }
  return *this;
}

Result<std::unique_ptr<ReadableFile>> MemoryFileSystem::open(const std::string& path) const {
  const std::lock_guard guard(state_->mutex);
  const auto found = state_->files.find(normalized(path));
  if (found == state_->files.end()) return absent(path);
  return std::unique_ptr<ReadableFile>(std::make_unique<MemoryReadableFile>(path, found->second));
}

Result<std::unique_ptr<WritableFile>> MemoryFileSystem::create(const std::string& path) const {
  const std::lock_guard guard(state_->mutex);
  const std::string name = normalized(path);
  if (state_->files.contains(name) || state_->folders.contains(name)) {
    return accessError(path, "cannot create", "File exists");
  }
  const std::string parent = parentOf(name);
  if (!parent.empty() && !state_->folders.contains(parent)) {
    return accessError(path, "cannot create", "No such file or directory");
  }
  const auto contents = std::make_shared<Bytes>();
  state_->files.emplace(name, contents);
  return std::unique_ptr<WritableFile>(std::make_unique<MemoryWritableFile>(contents));
}

Result<PathType> MemoryFileSystem::typeOf(const std::string& path) const {
  const std::lock_guard guard(state_->mutex);
  const std::string name = normalized(path);
  if (state_->files.contains(name)) return PathType::kFile;
  if (name.empty() || state_->folders.contains(name)) return PathType::kDirectory;
  return PathType::kAbsent;
}

Result<std::vector<std::string>> MemoryFileSystem::list(const std::string& path) const {
  const std::lock_guard guard(state_->mutex);
  const std::string name = normalized(path);
  if (!name.empty() && !state_->folders.contains(name)) return absent(path);
  std::vector<std::string> names;
  const auto take = [&](const std::string& entry) {
    if (!entry.empty() && parentOf(entry) == name) {
      names.push_back(name.empty() ? entry : entry.substr(name.size() + 1));
    }
  };
  for (const auto& [file, contents] : state_->files) take(file);
  for (const auto& folder : state_->folders) take(folder);
  std::sort(names.begin(), names.end());
  return names;
}

Status MemoryFileSystem::makeDirectory(const std::string& path) const {
  const std::lock_guard guard(state_->mutex);
  const std::string name = normalized(path);
  if (name.empty() || state_->files.contains(name) || state_->folders.contains(name)) {
    return accessError(path, "cannot create the folder", "File exists");
  }
  const std::string parent = parentOf(name);
  if (!parent.empty() && !state_->folders.contains(parent)) {
    return accessError(path, "cannot create the folder", "No such file or directory");
  }
  state_->folders.insert(name);
  return Success{};
}

Status MemoryFileSystem::rename(const std::string& from, const std::string& to) const {
  const std::lock_guard guard(state_->mutex);
  const std::string source = normalized(from);
  const std::string target = normalized(to);
  if (const auto file = state_->files.find(source); file != state_->files.end()) {
    if (state_->folders.contains(target)) return accessError(to, "cannot rename", "Is a directory");
    auto contents = file->second;
    state_->files.erase(file);
    state_->files[target] = std::move(contents);
    return Success{};
  }
  if (!state_->folders.contains(source)) return absent(from);
  if (state_->files.contains(target)) return accessError(to, "cannot rename", "Not a directory");
  const std::string inside = target + "/";
  const auto lies_inside = [](const std::string& path, const std::string& folder) {
    return path.starts_with(folder);
  };
  for (const auto& [file, contents] : state_->files) {
    if (lies_inside(file, inside)) return accessError(to, "cannot rename", "Directory not empty");
  }
  const std::string prefix = source + "/";
  std::map<std::string, std::shared_ptr<Bytes>> files;
  for (const auto& [file, contents] : state_->files) {
    files.emplace(lies_inside(file, prefix) ? inside + file.substr(prefix.size()) : file, contents);
  }
  std::set<std::string> folders = {target};
  for (const auto& folder : state_->folders) {
    if (folder == source) continue;
    folders.insert(lies_inside(folder, prefix) ? inside + folder.substr(prefix.size()) : folder);
  }
  state_->files = std::move(files);
  state_->folders = std::move(folders);
  return Success{};
}

Status MemoryFileSystem::renameNoReplace(const std::string& from, const std::string& to) const {
  const auto type = typeOf(to);
  if (type.ok() && type.value() != PathType::kAbsent) return usageError(to, "cannot rename", "File exists");
  return rename(from, to);
}

Status MemoryFileSystem::removeFile(const std::string& path) const {
  const std::lock_guard guard(state_->mutex);
  if (state_->files.erase(normalized(path)) == 0) return absent(path);
  return Success{};
}

Status MemoryFileSystem::removeDirectory(const std::string& path) const {
  const std::lock_guard guard(state_->mutex);
  const std::string name = normalized(path);
  if (!state_->folders.contains(name)) return absent(path);
  for (const auto& folder : state_->folders) {
    if (folder.starts_with(name + "/")) return accessError(path, "cannot remove", "Directory not empty");
  }
  std::erase_if(state_->files, [&](const auto& file) { return file.first.starts_with(name + "/"); });
  state_->folders.erase(name);
  return Success{};
}

Status MemoryFileSystem::syncFile(const std::string& path) const {
  const auto type = typeOf(path);
  if (!type.ok() || type.value() != PathType::kFile) return absent(path);
  return Success{};
}

Status MemoryFileSystem::syncDirectory(const std::string& path) const {
  const auto type = typeOf(path);
  if (!type.ok() || type.value() != PathType::kDirectory) return absent(path);
  return Success{};
}

Result<std::unique_ptr<FileLock>> MemoryFileSystem::lock(const std::string& path) const {
  const std::lock_guard guard(state_->mutex);
  const std::string name = normalized(path);
  const std::string parent = parentOf(name);
  if (!parent.empty() && !state_->folders.contains(parent)) return absent(path);
  if (!state_->locks.insert(name).second) {
    return accessError(path, "another writer has it", "Resource temporarily unavailable");
  }
  state_->files.try_emplace(name, std::make_shared<Bytes>());
  return std::unique_ptr<FileLock>(std::make_unique<MemoryLock>([state = state_, name] {
    const std::lock_guard release_guard(state->mutex);
    state->locks.erase(name);
  }));
}

const Bytes& MemoryFileSystem::bytes(const std::string& path) const {
  return *state_->files.at(normalized(path));
}

Bytes& MemoryFileSystem::mutableBytes(const std::string& path) {
  auto& contents = state_->files.at(normalized(path));
  // Snapshots share contents; the one that changes takes its own copy.
  if (contents.use_count() > 1) contents = std::make_shared<Bytes>(*contents);
  return *contents;
}

void MemoryFileSystem::setBytes(const std::string& path, Bytes contents) {
  const std::string name = normalized(path);
  for (std::string parent = parentOf(name); !parent.empty(); parent = parentOf(parent)) {
    state_->folders.insert(parent);
  }
  state_->files[name] = std::make_shared<Bytes>(std::move(contents));
}

void MemoryFileSystem::setText(const std::string& path, const std::string& text) {
  const auto bytes = std::as_bytes(std::span(text));
  setBytes(path, Bytes(bytes.begin(), bytes.end()));
}

std::string MemoryFileSystem::text(const std::string& path) const {
  const Bytes& contents = bytes(path);
  std::string text(contents.size(), '\0');
  std::transform(contents.begin(), contents.end(), text.begin(),
                 [](std::byte byte) { return static_cast<char>(std::to_integer<unsigned char>(byte)); });
  return text;
}

void MemoryFileSystem::flipBit(const std::string& path, std::uint64_t bit) {
  mutableBytes(path).at(static_cast<std::size_t>(bit / 8)) ^= static_cast<std::byte>(1u << (bit % 8));
}

std::vector<std::string> MemoryFileSystem::paths() const {
  std::vector<std::string> paths;
  for (const auto& [path, contents] : state_->files) paths.push_back(path);
  return paths;
}

std::vector<std::string> MemoryFileSystem::folders() const {
  return {state_->folders.begin(), state_->folders.end()};
}

}  // namespace deltaz
