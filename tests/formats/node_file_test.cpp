#include "formats/node_file.h"

#include <algorithm>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

namespace deltaz {
namespace {

NodeRecord arbitraryRecord() {
  NodeRecord record;
  record.type = *rc::gen::element(NodeType::kCluster, NodeType::kTerrain);
  record.level = *rc::gen::arbitrary<std::uint8_t>();
  record.child_number = *rc::gen::inRange<std::uint8_t>(0, 5);
  record.flags = *rc::gen::inRange<std::uint8_t>(0, 4);
  record.grid = *rc::gen::arbitrary<std::uint16_t>();
  record.x = *rc::gen::arbitrary<std::int32_t>();
  record.y = *rc::gen::arbitrary<std::int32_t>();
  record.first_child = *rc::gen::arbitrary<std::uint32_t>();
  record.sibling = *rc::gen::arbitrary<std::uint32_t>();
  record.segment = *rc::gen::arbitrary<std::uint32_t>();
  record.block = record.type == NodeType::kCluster ? kNoBlock : *rc::gen::inRange<std::uint32_t>(0, kNoBlock);
  for (std::int32_t& offset : record.centroid_offset) offset = *rc::gen::arbitrary<std::int32_t>();
  record.radius = *rc::gen::arbitrary<std::uint32_t>();
  record.minimum_height = *rc::gen::arbitrary<std::int32_t>();
  record.maximum_height = std::max(record.minimum_height, *rc::gen::arbitrary<std::int32_t>());
  for (std::int16_t& component : record.mean_normal) component = *rc::gen::arbitrary<std::int16_t>();
  record.cone_half_angle = *rc::gen::arbitrary<std::uint16_t>();
  record.geometric_error = *rc::gen::arbitrary<std::uint32_t>();
  record.coverage_error = *rc::gen::arbitrary<std::uint32_t>();
  record.rms_error = *rc::gen::arbitrary<std::uint32_t>();
  record.lod_near = 10;
  record.lod_far = 20;
  record.valid_posts = *rc::gen::arbitrary<std::uint32_t>();
  return record;
}

RC_GTEST_PROP(NodeFile, records_read_back_exactly, ()) {
  std::vector<NodeRecord> records(*rc::gen::inRange<std::size_t>(1, kNodesPerPage + 1));
  std::generate(records.begin(), records.end(), arbitraryRecord);
  const std::vector<std::byte> bytes = encodeNodePage(records);
  RC_ASSERT(bytes.size() == records.size() * kNodeRecordBytes);
  const Result<std::vector<NodeRecord>> back = decodeNodePage(bytes, "test");
  RC_ASSERT(back.ok());
  RC_ASSERT(back.value() == records);
}

// The bytes of node_file.md, written down by hand.
TEST(NodeFile, bytes_are_those_of_the_specification) {
  NodeRecord record;
  record.type = NodeType::kTerrain;
  record.level = 3;
  record.child_number = 4;
  record.flags = kNodeHasVoids;
  record.x = -2;
  record.segment = 0;
  record.block = 0x01020304;
  record.maximum_height = 0x1122;
  record.valid_posts = 65;
  const std::vector<std::byte> bytes = encodeNodePage({&record, 1});
  const auto at = [&](std::size_t offset) { return std::to_integer<int>(bytes[offset]); };
  EXPECT_EQ(at(0), 1);
  EXPECT_EQ(at(1), 3);
  EXPECT_EQ(at(2), 4);
  EXPECT_EQ(at(3), 1);
  EXPECT_EQ(at(8), 0xFE);
  EXPECT_EQ(at(11), 0xFF);
  EXPECT_EQ(at(28), 4);
  EXPECT_EQ(at(31), 1);
  EXPECT_EQ(at(52), 0x22);
  EXPECT_EQ(at(53), 0x11);
  EXPECT_EQ(at(64), 0xFF);
  EXPECT_EQ(at(84), 65);
}

TEST(NodeFile, values_a_record_cannot_have_are_refused) {
  const auto refused = [](std::size_t offset, int value) {
    NodeRecord record;
    std::vector<std::byte> bytes = encodeNodePage({&record, 1});
    bytes[offset] = static_cast<std::byte>(value);
    const Result<std::vector<NodeRecord>> result = decodeNodePage(bytes, "test");
    return !result.ok() && result.error().code == IssueCode::kRefRecord;
  };
  EXPECT_TRUE(refused(0, 9)) << "type";
  EXPECT_TRUE(refused(0, 1)) << "terrain without data";
  EXPECT_TRUE(refused(2, 5)) << "child number";
  EXPECT_TRUE(refused(3, 4)) << "flags";
  EXPECT_TRUE(refused(6, 1)) << "reserved";
  EXPECT_TRUE(refused(28, 0)) << "cluster with data";
  EXPECT_TRUE(refused(51, 0x7F)) << "heights out of order";
  EXPECT_TRUE(refused(79, 0xFF)) << "LOD ranges out of order";
  EXPECT_TRUE(refused(95, 1)) << "reserved at the end";
}

TEST(NodeFile, pages_of_wrong_length_are_refused) {
  std::vector<NodeRecord> records(kNodesPerPage);
  std::vector<std::byte> bytes = encodeNodePage(records);
  EXPECT_FALSE(decodeNodePage(std::span(bytes).first(bytes.size() - 1), "test").ok());
  EXPECT_FALSE(decodeNodePage({}, "test").ok());
  bytes.insert(bytes.end(), bytes.begin(), bytes.begin() + kNodeRecordBytes);
  EXPECT_FALSE(decodeNodePage(bytes, "test").ok());
}

}  // namespace
}  // namespace deltaz
