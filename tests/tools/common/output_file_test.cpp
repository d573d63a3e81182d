#include "tools/common/output_file.h"

#include <gtest/gtest.h>

#include "formats/file_system.h"
#include "tests/support/temporary_directory.h"

namespace deltaz {
namespace {

std::string contentOf(const std::string& path) {
  const auto bytes = readWholeFile(localFileSystem(), path, 1000);
  return bytes.ok() ? std::string(reinterpret_cast<const char*>(bytes.value().data()), bytes.value().size())
                    : "?";
}

TEST(OutputFile, a_new_file_appears_and_nothing_else) {
  const TemporaryDirectory folder;
  ASSERT_TRUE(writeOutput(folder.file("a.txt"), "text", false).ok());
  EXPECT_EQ(contentOf(folder.file("a.txt")), "text");
  EXPECT_EQ(localFileSystem().list(folder.path()).value(), std::vector<std::string>{"a.txt"});
}

TEST(OutputFile, an_existing_file_is_replaced_only_when_asked) {
  const TemporaryDirectory folder;
  ASSERT_TRUE(writeOutput(folder.file("a.txt"), "old", false).ok());
  const Status refused = writeOutput(folder.file("a.txt"), "new", false);
  ASSERT_FALSE(refused.ok());
  EXPECT_EQ(refused.error().kind, ErrorKind::kUsage);
  EXPECT_EQ(contentOf(folder.file("a.txt")), "old");
  ASSERT_TRUE(writeOutput(folder.file("a.txt"), "new", true).ok());
  EXPECT_EQ(contentOf(folder.file("a.txt")), "new");
  EXPECT_EQ(localFileSystem().list(folder.path()).value().size(), 1u);
}

TEST(OutputFile, places_that_cannot_be_written_are_named) {
  const TemporaryDirectory folder;
  ASSERT_TRUE(writeOutput(folder.file("a.txt"), "text", false).ok());
  for (const std::string& path : {folder.file("a.txt/b.txt"), folder.file("absent/b.txt")}) {
    const Status status = checkOutput(path, true);
    ASSERT_FALSE(status.ok());
    EXPECT_EQ(status.error().kind, ErrorKind::kCannotAccess);
    EXPECT_NE(status.error().message().find(path), std::string::npos);
  }
  EXPECT_EQ(checkOutput(folder.path(), true).error().kind, ErrorKind::kUsage);
}

// The root user may write into every folder, but /proc makes no files for anybody.
TEST(OutputFile, failures_are_told_of_the_file_that_was_asked_for) {
  for (const char* path : {"/proc/x.png", "/dev/full"}) {
    const Status status = writeOutput(path, "text", true);
    ASSERT_FALSE(status.ok());
    EXPECT_EQ(status.error().where, path);
    EXPECT_EQ(status.error().message().find("tmp-"), std::string::npos) << status.error().message();
  }
}

}  // namespace
}  // namespace deltaz
