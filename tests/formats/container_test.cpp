#include "formats/container.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "tests/support/container_surgery.h"
#include "tests/support/memory_file_system.h"

namespace deltaz {
namespace {

using Payloads = std::vector<std::vector<std::byte>>;

FileIdentity writeContainer(const FileSystem& files, const std::string& path, const Payloads& payloads) {
  Result<ContainerWriter> writer = ContainerWriter::create(files, path, ContentKind::kTerrain);
  EXPECT_TRUE(writer.ok());
  for (const std::vector<std::byte>& payload : payloads) {
    EXPECT_TRUE(writer.value().append(BlockType::kTerrainNode, payload).ok());
  }
  Result<FileIdentity> identity = writer.value().finish();
  EXPECT_TRUE(identity.ok());
  return identity.value();
}

MemoryFileSystem emptyDisk() {
  MemoryFileSystem files;
  EXPECT_TRUE(files.makeDirectory("/folder").ok());
  return files;
}

const std::string kPath = "/folder/file.dzt";

RC_GTEST_PROP(Container, blocks_read_back_whatever_their_number_and_size, ()) {
  const MemoryFileSystem files = emptyDisk();
  Payloads payloads(*rc::gen::inRange<std::size_t>(0, 300));
  for (std::vector<std::byte>& payload : payloads) {
    payload.assign(*rc::gen::inRange<std::size_t>(1, 40), static_cast<std::byte>(*rc::gen::inRange(0, 256)));
  }
  const FileIdentity identity = writeContainer(files, kPath, payloads);
  Result<ContainerReader> reader = ContainerReader::open(files, kPath, ContentKind::kTerrain);
  RC_ASSERT(reader.ok());
  RC_ASSERT(reader.value().identity().id == identity.id);
  RC_ASSERT(reader.value().identity().length == identity.length);
  RC_ASSERT(reader.value().blockCount() == payloads.size());
  for (std::uint32_t i = 0; i < payloads.size(); ++i) {
    const Result<std::vector<std::byte>> payload = reader.value().read(i, BlockType::kTerrainNode);
    RC_ASSERT(payload.ok());
    RC_ASSERT(payload.value() == payloads[i]);
  }
  RC_ASSERT(reader.value().checkIndex().ok());
  RC_ASSERT(reader.value().checkPadding().ok());
  RC_ASSERT(reader.value().checkFileId().ok());
  RC_ASSERT(!reader.value().read(static_cast<std::uint32_t>(payloads.size()), BlockType::kTerrainNode).ok());
}

TEST(Container, identity_depends_on_contents_and_their_order) {
  const MemoryFileSystem files = emptyDisk();
  const std::vector<std::byte> one(8, std::byte{1}), two(8, std::byte{2});
  const FileIdentity first = writeContainer(files, "/folder/a", {one, two});
  EXPECT_EQ(writeContainer(files, "/folder/b", {one, two}).id, first.id);
  EXPECT_NE(writeContainer(files, "/folder/c", {two, one}).id, first.id);
}

TEST(Container, a_newer_version_or_feature_is_refused_as_newer) {
  MemoryFileSystem files = emptyDisk();
  writeContainer(files, kPath, {{std::byte{1}}});
  const FileBytes good = files.bytes(kPath);
  for (const std::size_t offset : {kHeaderVersionOffset, kHeaderRequiredOffset}) {
    FileBytes bytes = good;
    bytes[offset] = static_cast<std::byte>(kContainerVersion + 1);
    sealHeader(bytes);
    files.setBytes(kPath, bytes);
    const Result<ContainerReader> reader = ContainerReader::open(files, kPath, ContentKind::kTerrain);
    ASSERT_FALSE(reader.ok());
    EXPECT_EQ(reader.error().kind, ErrorKind::kNewerFormat) << reader.error().message();
  }
  FileBytes bytes = good;
  bytes[kHeaderOptionalOffset] = std::byte{4};
  sealHeader(bytes);
  files.setBytes(kPath, bytes);
  const Result<ContainerReader> reader = ContainerReader::open(files, kPath, ContentKind::kTerrain);
  ASSERT_TRUE(reader.ok()) << "an optional feature is ignored";
  EXPECT_EQ(reader.value().optionalFeatures(), 4u);
}

TEST(Container, a_file_of_another_kind_is_refused) {
  const MemoryFileSystem files = emptyDisk();
  writeContainer(files, kPath, {{std::byte{1}}});
  const Result<ContainerReader> reader = ContainerReader::open(files, kPath, ContentKind::kNodes);
  ASSERT_FALSE(reader.ok());
  EXPECT_EQ(reader.error().code, IssueCode::kHdrField);
}

TEST(Container, a_block_of_another_type_is_refused) {
  const MemoryFileSystem files = emptyDisk();
  writeContainer(files, kPath, {{std::byte{1}}});
  Result<ContainerReader> reader = ContainerReader::open(files, kPath, ContentKind::kTerrain);
  ASSERT_TRUE(reader.ok());
  EXPECT_EQ(reader.value().read(0, BlockType::kNodePage).error().code, IssueCode::kRefData);
}

// Counts that a footer claims must fit the file before they size anything.
TEST(Container, an_impossible_block_count_is_refused) {
  MemoryFileSystem files = emptyDisk();
  writeContainer(files, kPath, {{std::byte{1}}});
  FileBytes bytes = files.bytes(kPath);
  store(bytes, footerOffset(bytes) + kFooterCountOffset, std::uint32_t{0xFFFFFFFF});
  sealFooter(bytes);
  files.setBytes(kPath, bytes);
  const Result<ContainerReader> reader = ContainerReader::open(files, kPath, ContentKind::kTerrain);
  ASSERT_FALSE(reader.ok());
  EXPECT_EQ(reader.error().code, IssueCode::kHdrField);
}

// Only the first block of an index page says where it lies; the pages must go on from each other all the
// same.
TEST(Container, an_index_page_that_begins_elsewhere_is_refused) {
  MemoryFileSystem files = emptyDisk();
  writeContainer(files, kPath, Payloads(kIndexEntriesPerPage + 2, std::vector<std::byte>(8, std::byte{7})));
  FileBytes bytes = files.bytes(kPath);
  const auto second_page = static_cast<std::uint32_t>(kIndexEntriesPerPage);
  BlockLocation entry = entryOf(bytes, second_page);
  entry.offset -= kBlockAlignment;  // the block before it holds the same bytes
  storeEntry(bytes, second_page, entry);
  sealIndexPages(bytes);
  files.setBytes(kPath, bytes);
  const Result<ContainerReader> reader = ContainerReader::open(files, kPath, ContentKind::kTerrain);
  ASSERT_TRUE(reader.ok());
  EXPECT_TRUE(reader.value().read(second_page - 1, BlockType::kTerrainNode).ok());
  EXPECT_EQ(reader.value().read(second_page, BlockType::kTerrainNode).error().code, IssueCode::kSumBlock);
  EXPECT_EQ(reader.value().checkIndex().error().code, IssueCode::kIdxOrder);
}

}  // namespace
}  // namespace deltaz
