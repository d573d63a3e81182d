#include "libdb/access/node_pages.h"

#include <gtest/gtest.h>

#include "tests/support/container_surgery.h"

namespace deltaz {
namespace {

const std::string kPath = "nodes.dzn";

std::vector<NodeRecord> recordsFrom(std::uint32_t first, std::uint32_t count) {
  std::vector<NodeRecord> records(count);
  for (std::uint32_t k = 0; k < count; ++k) records[k].valid_posts = first + k;
  return records;
}

// A node file whose pages have so many records, and an area that says how many there are in all.
class NodePages : public testing::Test {
 protected:
  void write(const std::vector<std::uint32_t>& counts, BlockType type = BlockType::kPackedNodePage) {
    std::vector<std::vector<std::byte>> pages;
    area_.node_count = 0;
    area_.nodes_per_page = kNodesPerPage;
    for (const std::uint32_t count : counts) {
      const auto page = static_cast<std::uint32_t>(pages.size());
      pages.push_back(encodeNodePage(recordsFrom(area_.node_count + 1, count), page * kNodesPerPage + 1));
      area_.node_count += count;
    }
    files_.setBytes(kPath, makeContainer(ContentKind::kNodes, type, pages));
  }
  Result<std::vector<NodeRecord>> read(std::uint32_t page) {
    Result<ContainerReader> reader = ContainerReader::open(files_, kPath, ContentKind::kNodes);
    if (!reader.ok()) return reader.error();
    return readNodePage(reader.value(), area_, page);
  }

  MemoryFileSystem files_;
  AreaHeader area_;
};

TEST_F(NodePages, pages_are_full_but_for_the_last) {
  write({kNodesPerPage, kNodesPerPage, 3});
  EXPECT_EQ(nodePageCount(area_), 3u);
  EXPECT_EQ(read(1).value(), recordsFrom(kNodesPerPage + 1, kNodesPerPage));
  EXPECT_EQ(read(2).value(), recordsFrom(2 * kNodesPerPage + 1, 3));
  write({kNodesPerPage});
  EXPECT_EQ(nodePageCount(area_), 1u);
}

TEST_F(NodePages, a_page_of_another_number_of_records_is_refused) {
  write({kNodesPerPage - 1, 5});
  area_.node_count = kNodesPerPage + 4;
  EXPECT_EQ(read(0).error().code, IssueCode::kRefRecord);
  EXPECT_EQ(read(1).error().code, IssueCode::kRefRecord);
}

TEST_F(NodePages, packed_pages_where_the_area_has_plain_ones_are_refused) {
  write({kNodesPerPage});
  area_.nodes_per_page = kNodesPerPlainPage;
  EXPECT_EQ(read(0).error().code, IssueCode::kRefData);
  write({kNodesPerPage}, BlockType::kNodePage);
  EXPECT_EQ(read(0).error().code, IssueCode::kRefData);
}

}  // namespace
}  // namespace deltaz
