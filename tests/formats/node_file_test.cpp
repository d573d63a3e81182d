#include "formats/node_file.h"

#include <algorithm>
#include <functional>
#include <gtest/gtest.h>
#include <optional>
#include <rapidcheck/gtest.h>

#include "formats/bit_columns.h"

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
  const auto number = *rc::gen::arbitrary<std::uint32_t>();
  // Links to themselves, before or behind, as damage may make them.
  for (NodeRecord& record : records)
    record.sibling = *rc::gen::element<std::uint32_t>(0, record.sibling, number, number + 1, number - 1);
  const std::vector<std::byte> bytes = encodeNodePage(records, number);
  const Result<std::vector<NodeRecord>> back = decodeNodePage(bytes, number, "test");
  RC_ASSERT(back.ok());
  RC_ASSERT(back.value() == records);
}

// A page as the builder makes them: sixteen leaves side by side, four to a parent.
std::vector<NodeRecord> pageOfLeaves(std::uint32_t first_number) {
  std::vector<NodeRecord> records;
  for (std::uint32_t slot = 0; slot < kNodesPerPage; ++slot) {
    NodeRecord record;
    record.type = NodeType::kTerrain;
    record.child_number = static_cast<std::uint8_t>(slot % 4 + 1);
    record.x = static_cast<std::int32_t>(9860 + slot / 4);
    record.y = 23031;
    record.sibling = slot % 4 == 3 ? 0 : first_number + slot + 1;
    record.segment = 1;
    record.block = 7000 + slot;
    record.geometric_error = record.coverage_error = record.rms_error = 0;
    record.valid_posts = 4225;
    records.push_back(record);
  }
  return records;
}

TEST(NodeFile, links_that_are_as_usual_take_no_room) {
  const std::vector<NodeRecord> records = pageOfLeaves(20001);
  // 5 bytes of rows and mask; type, y, segment, block and posts without bits, 9 bytes of bases and 5 widths;
  // child number (2 bits), x (2) and sibling (1): 5 bytes of bases, 3 widths, 80 bits.
  EXPECT_EQ(encodeNodePage(records, 20001).size(), 5u + 9 + 5 + 5 + 3 + 10);
}

// The bytes of node_file.md, written down by hand.
TEST(NodeFile, bytes_are_those_of_the_specification) {
  NodeRecord record;
  record.type = NodeType::kTerrain;
  record.flags = kNodeHasVoids;
  record.x = -2;
  record.first_child = 9;
  record.sibling = 6;
  record.block = 3;
  record.minimum_height = 10;
  record.maximum_height = 14;
  record.geometric_error = record.coverage_error = record.rms_error = 0;
  const std::vector<std::byte> bytes = encodeNodePage({&record, 1}, 5);
  const std::vector<int> expected = {
      1,                             // record
      0b10101001, 0b10000101, 1, 0,  // type, flags, x, first child, sibling, block, heights
      2,          0,                 // type 1
      2,          0,                 // flags 1
      3,          0,                 // x -2
      0x92,       1,          0,     // first child 9 + 4 x 16 - 0
      2,          0,                 // sibling 6 - 5
      6,          0,                 // block 3 - 0
      20,         0,                 // lowest height 10
      8,          0,                 // highest height 14 - 10
  };
  std::vector<int> actual;
  for (const std::byte byte : bytes) actual.push_back(std::to_integer<int>(byte));
  EXPECT_EQ(actual, expected);
}

TEST(NodeFile, values_a_record_cannot_have_are_refused) {
  const auto refused = [](const std::function<void(NodeRecord&)>& spoil) {
    NodeRecord record;
    spoil(record);
    const auto result = decodeNodePage(encodeNodePage({&record, 1}, 1), 1, "test");
    return !result.ok() && result.error().code == IssueCode::kRefRecord;
  };
  EXPECT_FALSE(refused([](NodeRecord&) {}));
  EXPECT_TRUE(refused([](NodeRecord& record) { record.type = static_cast<NodeType>(9); }));
  EXPECT_TRUE(refused([](NodeRecord& record) { record.type = NodeType::kTerrain; })) << "without data";
  EXPECT_TRUE(refused([](NodeRecord& record) { record.child_number = 5; }));
  EXPECT_TRUE(refused([](NodeRecord& record) { record.flags = 4; }));
  EXPECT_TRUE(refused([](NodeRecord& record) { record.block = 0; })) << "cluster with data";
  EXPECT_TRUE(refused([](NodeRecord& record) { record.minimum_height = 1; })) << "heights out of order";
  EXPECT_TRUE(refused([](NodeRecord& record) { record.lod_near = 1; })) << "LOD ranges out of order";
}

TEST(NodeFile, values_that_do_not_fit_their_fields_are_refused) {
  NodeRecord record;
  record.level = 255;
  const std::vector<std::byte> good = encodeNodePage({&record, 1}, 1);
  ASSERT_TRUE(decodeNodePage(good, 1, "test").ok());
  std::optional<BitColumns> columns = unpackColumns(good, 27, 1);
  ASSERT_TRUE(columns.has_value());
  EXPECT_EQ(columns->values[1], 255);
  columns->values[1] = 256;
  EXPECT_FALSE(decodeNodePage(packColumns(*columns), 1, "test").ok()) << "level";
  columns->values[1] = 255;
  columns->values[7] = 64;
  EXPECT_FALSE(decodeNodePage(packColumns(*columns), 1, "test").ok()) << "first child 0 by another name";
  columns->values[7] = 0;
  columns->values[8] = -2;
  EXPECT_FALSE(decodeNodePage(packColumns(*columns), 1, "test").ok()) << "sibling 0 by another name";
}

TEST(NodeFile, pages_of_wrong_length_are_refused) {
  const std::vector<NodeRecord> records = pageOfLeaves(1);
  std::vector<std::byte> bytes = encodeNodePage(records, 1);
  ASSERT_TRUE(decodeNodePage(bytes, 1, "test").ok());
  EXPECT_FALSE(decodeNodePage(std::span(bytes).first(bytes.size() - 1), 1, "test").ok());
  EXPECT_FALSE(decodeNodePage({}, 1, "test").ok());
  bytes.push_back(std::byte{0});
  EXPECT_FALSE(decodeNodePage(bytes, 1, "test").ok());
}

// The plain record of the first databases, at the offsets of node_file.md.
class PlainPage {
 public:
  PlainPage() : bytes(kPlainNodeRecordBytes) {
    set(28, {0xFF, 0xFF, 0xFF, 0xFF});  // no block
  }
  PlainPage& set(std::size_t offset, std::initializer_list<int> values) {
    for (const int value : values) bytes[offset++] = static_cast<std::byte>(value);
    return *this;
  }
  bool refused() const {
    const auto result = decodePlainNodePage(bytes, "test");
    return !result.ok() && result.error().code == IssueCode::kRefRecord;
  }
  std::vector<std::byte> bytes;
};

TEST(NodeFile, plain_records_are_read_field_by_field) {
  PlainPage page;
  page.set(0, {1, 3, 4, 1, 7, 0}).set(8, {0xFE, 0xFF, 0xFF, 0xFF, 5}).set(16, {9, 1}).set(20, {6});
  page.set(24, {1}).set(28, {4, 3, 2, 1}).set(32, {1, 0, 0, 0, 2, 0, 0, 0, 3}).set(44, {8});
  page.set(48, {0x9C, 0xFF, 0xFF, 0xFF, 0x22, 0x11}).set(56, {0xFF, 0x7F, 1, 0, 2, 0, 3, 0});
  page.set(64, {10}).set(68, {11}).set(72, {12}).set(78, {0x80, 0x3F, 0, 0, 0, 0x40}).set(84, {65});
  NodeRecord expected;
  expected.type = NodeType::kTerrain;
  expected.level = 3;
  expected.child_number = 4;
  expected.flags = kNodeHasVoids;
  expected.grid = 7;
  expected.x = -2;
  expected.y = 5;
  expected.first_child = 265;
  expected.sibling = 6;
  expected.segment = 1;
  expected.block = 0x01020304;
  expected.centroid_offset = {1, 2, 3};
  expected.radius = 8;
  expected.minimum_height = -100;
  expected.maximum_height = 0x1122;
  expected.mean_normal = {32767, 1, 2};
  expected.cone_half_angle = 3;
  expected.geometric_error = 10;
  expected.coverage_error = 11;
  expected.rms_error = 12;
  expected.lod_near = 1;
  expected.lod_far = 2;
  expected.valid_posts = 65;
  const auto records = decodePlainNodePage(page.bytes, "test");
  ASSERT_TRUE(records.ok()) << records.error().message();
  ASSERT_EQ(records.value().size(), 1u);
  EXPECT_EQ(records.value()[0], expected);
}

TEST(NodeFile, values_a_plain_record_cannot_have_are_refused) {
  EXPECT_FALSE(PlainPage().refused());
  EXPECT_TRUE(PlainPage().set(0, {9}).refused()) << "type";
  EXPECT_TRUE(PlainPage().set(0, {1}).refused()) << "terrain without data";
  EXPECT_TRUE(PlainPage().set(2, {5}).refused()) << "child number";
  EXPECT_TRUE(PlainPage().set(3, {4}).refused()) << "flags";
  EXPECT_TRUE(PlainPage().set(6, {1}).refused()) << "reserved";
  EXPECT_TRUE(PlainPage().set(28, {0}).refused()) << "cluster with data";
  EXPECT_TRUE(PlainPage().set(51, {0x7F}).refused()) << "heights out of order";
  EXPECT_TRUE(PlainPage().set(79, {0xFF}).refused()) << "LOD ranges out of order";
  EXPECT_TRUE(PlainPage().set(95, {1}).refused()) << "reserved at the end";
}

TEST(NodeFile, plain_pages_of_wrong_length_are_refused) {
  PlainPage page;
  const std::vector<std::byte> one = page.bytes;
  EXPECT_FALSE(decodePlainNodePage(std::span(one).first(one.size() - 1), "test").ok());
  EXPECT_FALSE(decodePlainNodePage({}, "test").ok());
  std::vector<std::byte> many;
  for (std::uint32_t k = 0; k < kNodesPerPlainPage; ++k) many.insert(many.end(), one.begin(), one.end());
  EXPECT_TRUE(decodePlainNodePage(many, "test").ok());
  many.insert(many.end(), one.begin(), one.end());
  EXPECT_FALSE(decodePlainNodePage(many, "test").ok());
}

}  // namespace
}  // namespace deltaz
