#include "formats/terrain_segment.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

namespace deltaz {
namespace {

TerrainBlock sampleBlock(std::uint16_t columns, std::uint16_t rows) {
  TerrainBlock block;
  block.columns = columns;
  block.rows = rows;
  block.first_column = 3;
  block.spacing_x = 3.0 / 3600;
  block.spacing_y = 1.0 / 3600;
  block.quantum = {381, 1250};
  const std::size_t posts = static_cast<std::size_t>(columns + 2) * static_cast<std::size_t>(rows + 2);
  for (std::size_t k = 0; k < posts; ++k)
    block.heights.push_back(static_cast<std::int32_t>(k * k % 977) + 4000);
  block.valid.assign(posts, 1);
  block.ancestors = {{10, 400, 5}, {kMaximumLeafCells, 123456789012345ull, 7}};
  return block;
}

RC_GTEST_PROP(TerrainSegment, blocks_read_back_exactly, ()) {
  TerrainBlock block =
      sampleBlock(*rc::gen::inRange<std::uint16_t>(0, 12), *rc::gen::inRange<std::uint16_t>(0, 12));
  block.valid = *rc::gen::container<std::vector<std::uint8_t>>(block.heights.size(),
                                                               rc::gen::element<std::uint8_t>(0, 1));
  block.void_kinds = std::vector<std::uint8_t>(block.heights.size(), 0);
  for (std::size_t k = 0; k < block.valid.size(); k += 3)
    block.void_kinds[k] = block.valid[k] == 0 ? std::uint8_t{2} : std::uint8_t{0};
  const Result<TerrainBlock> back = decodeTerrainBlock(encodeTerrainBlock(block), 64, "test");
  RC_ASSERT(back.ok());
  RC_ASSERT(back.value().columns == block.columns);
  RC_ASSERT(back.value().rows == block.rows);
  RC_ASSERT(back.value().first_column == block.first_column);
  RC_ASSERT(back.value().spacing_x == block.spacing_x);
  RC_ASSERT(back.value().quantum == block.quantum);
  RC_ASSERT(back.value().ancestors == block.ancestors);
  RC_ASSERT(back.value().valid == block.valid);
  std::vector<std::uint8_t> kinds = back.value().void_kinds;
  kinds.resize(block.heights.size(), 0);
  RC_ASSERT(kinds == block.void_kinds);
  for (std::size_t k = 0; k < block.heights.size(); ++k) {
    if (block.valid[k] != 0) RC_ASSERT(back.value().heights[k] == block.heights[k]);
  }
}

TEST(TerrainSegment, equal_blocks_give_equal_bytes_whatever_stands_at_voids) {
  TerrainBlock block = sampleBlock(5, 5);
  block.valid[10] = 0;
  TerrainBlock other = block;
  other.heights[10] = -12345;
  EXPECT_EQ(encodeTerrainBlock(block), encodeTerrainBlock(other));
}

TEST(TerrainSegment, more_posts_than_a_leaf_are_refused_before_anything_is_allocated) {
  const std::vector<std::byte> bytes = encodeTerrainBlock(sampleBlock(66, 10));
  const Result<TerrainBlock> result = decodeTerrainBlock(bytes, 64, "test");
  ASSERT_FALSE(result.ok());
  EXPECT_EQ(result.error().code, IssueCode::kHgtDecode);
}

TEST(TerrainSegment, every_prefix_and_every_extra_byte_is_refused) {
  std::vector<std::byte> bytes = encodeTerrainBlock(sampleBlock(4, 4));
  for (std::size_t length = 0; length < bytes.size(); ++length) {
    EXPECT_FALSE(decodeTerrainBlock(std::span(bytes).first(length), 64, "test").ok()) << length;
  }
  bytes.push_back(std::byte{0});
  EXPECT_FALSE(decodeTerrainBlock(bytes, 64, "test").ok());
}

TEST(TerrainSegment, terrain_predicted_from_its_parent_is_refused_as_newer) {
  std::vector<std::byte> bytes = encodeTerrainBlock(sampleBlock(4, 4));
  bytes[1] = std::byte{1};
  const Result<TerrainBlock> result = decodeTerrainBlock(bytes, 64, "test");
  ASSERT_FALSE(result.ok());
  EXPECT_EQ(result.error().kind, ErrorKind::kNewerFormat);
}

}  // namespace
}  // namespace deltaz
