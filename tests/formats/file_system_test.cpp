// The machine's file system and the one in memory keep the same promises.
#include "formats/file_system.h"

#include <gtest/gtest.h>

#include "tests/support/memory_file_system.h"
#include "tests/support/temporary_directory.h"

namespace deltaz {
namespace {

std::span<const std::byte> bytesOf(std::string_view text) {
  return std::as_bytes(std::span(text.data(), text.size()));
}

void writeFile(const FileSystem& files, const std::string& path, std::string_view text) {
  Result<std::unique_ptr<WritableFile>> file = files.create(path);
  ASSERT_TRUE(file.ok()) << file.error().message();
  ASSERT_TRUE(file.value()->append(bytesOf(text)).ok());
  ASSERT_TRUE(file.value()->sync().ok());
  ASSERT_TRUE(file.value()->close().ok());
}

// What every file system must do, in a folder that exists and is empty.
void keepsThePromises(const FileSystem& files, const std::string& folder) {
  const std::string a = joinPath(folder, "a");
  const std::string b = joinPath(folder, "b");
  EXPECT_EQ(files.typeOf(a).value(), PathType::kAbsent);
  EXPECT_FALSE(files.open(a).ok());
  writeFile(files, a, "hello");
  EXPECT_EQ(files.typeOf(a).value(), PathType::kFile);
  EXPECT_FALSE(files.create(a).ok()) << "an existing file is never truncated";
  Result<std::unique_ptr<ReadableFile>> reader = files.open(a);
  ASSERT_TRUE(reader.ok());
  EXPECT_EQ(reader.value()->size(), 5u);
  std::array<std::byte, 3> middle{};
  EXPECT_TRUE(reader.value()->readAt(1, middle).ok());
  EXPECT_EQ(middle[0], std::byte{'e'});
  EXPECT_FALSE(reader.value()->readAt(3, middle).ok()) << "reading past the end is an error";

  writeFile(files, b, "other");
  EXPECT_EQ(files.renameNoReplace(a, b).error().kind, ErrorKind::kUsage);
  EXPECT_EQ(files.list(folder).value(), (std::vector<std::string>{"a", "b"}));
  EXPECT_TRUE(files.rename(a, b).ok());
  EXPECT_EQ(files.list(folder).value(), std::vector<std::string>{"b"});

  const std::string sub = joinPath(folder, "sub");
  EXPECT_TRUE(files.makeDirectory(sub).ok());
  EXPECT_FALSE(files.makeDirectory(sub).ok());
  EXPECT_EQ(files.typeOf(sub).value(), PathType::kDirectory);
  EXPECT_TRUE(files.renameNoReplace(sub, joinPath(folder, "moved")).ok());
  writeFile(files, joinPath(folder, "moved/inside"), "x");
  EXPECT_TRUE(files.syncFile(b).ok());
  EXPECT_FALSE(files.syncFile(a).ok());
  EXPECT_TRUE(files.syncDirectory(folder).ok());
  EXPECT_TRUE(files.removeDirectory(joinPath(folder, "moved")).ok());
  EXPECT_TRUE(files.removeFile(b).ok());
  EXPECT_FALSE(files.removeFile(b).ok());

  {
    const Result<std::unique_ptr<FileLock>> first = files.lock(a);
    ASSERT_TRUE(first.ok());
    const Result<std::unique_ptr<FileLock>> second = files.lock(a);
    ASSERT_FALSE(second.ok());
    EXPECT_EQ(second.error().kind, ErrorKind::kCannotAccess);
  }
  EXPECT_TRUE(files.lock(a).ok()) << "released with its holder";
}

TEST(FileSystem, local_keeps_the_promises) {
  const TemporaryDirectory folder;
  keepsThePromises(localFileSystem(), folder.path());
}

TEST(FileSystem, memory_keeps_the_promises) {
  const MemoryFileSystem files;
  ASSERT_TRUE(files.makeDirectory("/folder").ok());
  keepsThePromises(files, "/folder");
}

TEST(FileSystem, paths_take_apart_and_join) {
  EXPECT_EQ(baseName("a/b/c.dz"), "c.dz");
  EXPECT_EQ(baseName("a/b/c.dz/"), "c.dz");
  EXPECT_EQ(baseName("c"), "c");
  EXPECT_EQ(parentPath("a/b/c"), "a/b");
  EXPECT_EQ(parentPath("c/"), ".");
  EXPECT_EQ(parentPath("/c"), "/");
  EXPECT_EQ(joinPath("a/", "b"), "a/b");
  EXPECT_EQ(joinPath("a", "b"), "a/b");
}

}  // namespace
}  // namespace deltaz
