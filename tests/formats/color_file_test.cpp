#include "formats/color_file.h"

#include <algorithm>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "formats/zstd_packing.h"
#include "tests/support/byte_changes.h"

namespace deltaz {
namespace {

ColorDirectory sampleDirectory() {
  ColorDirectory directory;
  directory.node_count = 300;
  directory.first_page = 300;
  directory.trees = {{0, 1, 2, 9, -3}, {3, 3, 4, 60, -40}};
  return directory;
}
constexpr std::uint32_t kSampleBlocks = 300 + 3 + 1;

std::optional<BlockBytes> recodeDirectory(std::span<const std::byte> bytes) {
  const auto directory = decodeColorDirectory(bytes, kSampleBlocks, "test");
  if (!directory.ok()) {
    EXPECT_EQ(directory.error().code, IssueCode::kColorTree);
    return std::nullopt;
  }
  return encodeColorDirectory(directory.value());
}

std::optional<BlockBytes> recodePage(std::span<const std::byte> bytes) {
  const auto nodes = decodeColorPage(bytes, "test");
  if (!nodes.ok()) {
    EXPECT_EQ(nodes.error().code, IssueCode::kColorTree);
    return std::nullopt;
  }
  return encodeColorPage(nodes.value());
}

std::vector<ColorNode> sampleNodes() {
  return {{0, 5, 15, -1, 2147483647, 2, 7}, {3, -40, 0, -2147483647 - 1, 0, 0, 0}, {1, 60, 4, 1, 1, 300, 1}};
}

// Texels as a photograph has them: smooth, with noise; `cover` at every texel.
std::vector<std::uint8_t> sampleTexels(std::uint8_t cover) {
  std::vector<std::uint8_t> texels(kColorTileBytes);
  for (std::size_t k = 0; k < kColorTileBytes / 4 && cover > 0; ++k) {
    const std::size_t column = k % kColorTileSide, row = k / kColorTileSide;
    texels[4 * k] = static_cast<std::uint8_t>(column + row);
    texels[4 * k + 1] = static_cast<std::uint8_t>(2 * column + k * 7919 % 5);
    texels[4 * k + 2] = static_cast<std::uint8_t>(255 - row);
    texels[4 * k + 3] = cover;
  }
  return texels;
}

TEST(ColorDirectory, reads_back_exactly_and_has_one_form) {
  const BlockBytes bytes = encodeColorDirectory(sampleDirectory());
  const auto back = decodeColorDirectory(bytes, kSampleBlocks, "test");
  ASSERT_TRUE(back.ok()) << back.error().message();
  EXPECT_EQ(back.value(), sampleDirectory());
  expectCutsRefused(bytes, recodeDirectory);
  EXPECT_GT(expectOneForm(bytes, recodeDirectory), 0u);
}

TEST(ColorDirectory, counts_must_be_those_of_the_file) {
  const BlockBytes bytes = encodeColorDirectory(sampleDirectory());
  for (const std::uint32_t blocks : {0u, 1u, kSampleBlocks - 1, kSampleBlocks + 1, 0xFFFFFFFFu})
    EXPECT_FALSE(decodeColorDirectory(bytes, blocks, "test").ok()) << blocks;
  // As many nodes as there can be numbers.
  ColorDirectory huge = sampleDirectory();
  huge.node_count = huge.first_page = 0xFFFFFFFF;
  EXPECT_FALSE(decodeColorDirectory(encodeColorDirectory(huge), 33554432, "test").ok());
}

TEST(ColorDirectory, trees_that_contradict_each_other_are_refused) {
  const auto accepted = [](const std::function<void(ColorDirectory&)>& change) {
    ColorDirectory directory = sampleDirectory();
    change(directory);
    return decodeColorDirectory(encodeColorDirectory(directory), kSampleBlocks, "test").ok();
  };
  EXPECT_TRUE(accepted([](auto&) {}));
  EXPECT_TRUE(accepted([](auto& d) { d.trees[1].grid = 1; }));
  EXPECT_FALSE(accepted([](auto& d) { d.trees[1].grid = 0; })) << "a grid twice";
  EXPECT_FALSE(accepted([](auto& d) { std::swap(d.trees[0].grid, d.trees[1].grid); })) << "out of order";
  EXPECT_FALSE(accepted([](auto& d) { d.trees[0].finest_level = 10; })) << "finer is coarser";
  EXPECT_FALSE(accepted([](auto& d) { d.trees[1].finest_level = -41; }));
  EXPECT_FALSE(accepted([](auto& d) { d.trees[1].coarsest_level = 61; }));
  EXPECT_FALSE(accepted([](auto& d) { d.trees[1].root_count = 5; })) << "too many roots";
  EXPECT_FALSE(accepted([](auto& d) { d.trees[1].root_count = 0; }));
  EXPECT_FALSE(accepted([](auto& d) { d.trees[1].first_root = 4; })) << "a gap between roots";
  EXPECT_FALSE(accepted([](auto& d) { d.first_page = 299; }));
}

TEST(ColorPage, reads_back_exactly_and_has_one_form) {
  const std::vector<ColorNode> nodes = sampleNodes();
  const BlockBytes bytes = encodeColorPage(nodes);
  const auto back = decodeColorPage(bytes, "test");
  ASSERT_TRUE(back.ok()) << back.error().message();
  EXPECT_EQ(back.value(), nodes);
  EXPECT_GT(expectOneForm(bytes, recodePage), 0u);
  // A page may end after any whole record, and nowhere else.
  for (std::size_t length = 0; length <= bytes.size() + 1; ++length) {
    BlockBytes cut = bytes;
    cut.resize(length);
    const bool whole = length > 0 && length <= bytes.size() && length % (bytes.size() / nodes.size()) == 0;
    EXPECT_EQ(recodePage(cut).has_value(), whole) << length;
  }
}

TEST(ColorPage, more_records_than_a_page_holds_are_refused) {
  const std::vector<ColorNode> nodes(kColorNodesPerPage, sampleNodes()[1]);
  BlockBytes bytes = encodeColorPage(nodes);
  EXPECT_TRUE(recodePage(bytes).has_value());
  const BlockBytes one = encodeColorPage(std::span(nodes).first(1));
  bytes.insert(bytes.end(), one.begin(), one.end());
  EXPECT_FALSE(recodePage(bytes).has_value());
}

RC_GTEST_PROP(ColorTile, texels_read_back_exactly, (std::uint32_t seed)) {
  std::vector<std::uint8_t> texels(kColorTileBytes);
  const bool covered = seed % 2 == 0;
  std::uint32_t state = seed;
  for (std::size_t k = 0; k < texels.size(); k += 4) {
    state = state * 1664525u + 1013904223u;
    const auto cover = static_cast<std::uint8_t>(covered ? 255u : (state >> 24) % 5 == 0 ? 0u : state >> 24);
    if (cover == 0) continue;
    for (std::size_t c = 0; c < 3; ++c) texels[k + c] = static_cast<std::uint8_t>(state >> (7 * c));
    texels[k + 3] = cover;
  }
  const auto back = decodeColorTile(encodeColorTile(texels), "test");
  RC_ASSERT(back.ok());
  RC_ASSERT(back.value() == texels);
}

TEST(ColorTile, tiles_of_one_cover_read_back) {
  for (const int cover : {0, 1, 254, 255}) {
    const std::vector<std::uint8_t> texels = sampleTexels(static_cast<std::uint8_t>(cover));
    const auto back = decodeColorTile(encodeColorTile(texels), "test");
    ASSERT_TRUE(back.ok()) << back.error().message();
    EXPECT_EQ(back.value(), texels);
  }
}

TEST(ColorTile, every_cut_and_every_changed_byte_is_refused_or_gives_texels_that_read_back) {
  const BlockBytes bytes = encodeColorTile(sampleTexels(77));
  const auto recode = [](std::span<const std::byte> input) -> std::optional<BlockBytes> {
    const auto texels = decodeColorTile(input, "test");
    if (!texels.ok()) {
      EXPECT_EQ(texels.error().code, IssueCode::kColorTile);
      return std::nullopt;
    }
    EXPECT_EQ(texels.value().size(), kColorTileBytes);
    const BlockBytes again = encodeColorTile(texels.value());
    EXPECT_EQ(decodeColorTile(again, "test").value(), texels.value());
    return again;
  };
  expectCutsRefused(bytes, recode);
  // zstd has several spellings of the same bytes, so only what is read is compared.
  for (std::size_t place = 0; place < bytes.size(); place += place < 64 ? 1 : 29) {
    for (const unsigned change : {1u, 0x80u, 0xFFu}) {
      BlockBytes changed = bytes;
      changed[place] ^= static_cast<std::byte>(change);
      (void)recode(changed);
    }
  }
}

TEST(ColorTile, a_header_has_one_form) {
  const BlockBytes bytes = encodeColorTile(sampleTexels(255));
  for (std::size_t place = 0; place < 4; ++place) {
    for (unsigned change = 1; change < 256; ++change) {
      BlockBytes changed = bytes;
      changed[place] ^= static_cast<std::byte>(change);
      EXPECT_FALSE(decodeColorTile(changed, "test").ok()) << place << " " << change;
    }
  }
}

constexpr std::size_t kTexels = kColorTileBytes / 4;

BlockBytes tileOf(std::uint8_t flags, const BlockBytes& planes) {
  BlockBytes bytes(4);
  bytes[0] = std::byte{flags};
  const BlockBytes packed = packBytes(planes);
  bytes.insert(bytes.end(), packed.begin(), packed.end());
  return bytes;
}

// Planes of residuals whose first value stands for all of the plane: the predictions repeat it.
TEST(ColorTile, cover_that_says_nothing_and_colour_without_cover_are_refused) {
  const auto planes = [](std::uint8_t green, std::uint8_t cover) {
    BlockBytes raw(4 * kTexels);
    raw[0] = std::byte{green};
    raw[3 * kTexels] = std::byte{cover};
    return raw;
  };
  EXPECT_TRUE(decodeColorTile(tileOf(1, planes(9, 254)), "test").ok());
  EXPECT_TRUE(decodeColorTile(tileOf(1, planes(0, 0)), "test").ok());
  EXPECT_FALSE(decodeColorTile(tileOf(1, planes(9, 255)), "test").ok()) << "full cover spelt out";
  EXPECT_FALSE(decodeColorTile(tileOf(1, planes(9, 0)), "test").ok()) << "a colour without cover";
  EXPECT_FALSE(decodeColorTile(tileOf(0, planes(9, 0)), "test").ok()) << "a plane too many";
  EXPECT_FALSE(decodeColorTile(tileOf(1, BlockBytes(3 * kTexels)), "test").ok()) << "a plane too few";
}

}  // namespace
}  // namespace deltaz
