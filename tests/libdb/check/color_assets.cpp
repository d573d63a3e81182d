// Colour maps whose tree, tiles, borders or coarser texels are wrong.
#include <gtest/gtest.h>

#include "formats/bytes.h"
#include "formats/zstd_packing.h"
#include "tests/libdb/check/code_assets.h"
#include "tests/support/asset_editor.h"
#include "tests/support/color_map_fixture.h"

namespace deltaz {

namespace {

constexpr int kFinestLevel = 3;  // texels of half a cell

const MemoryFileSystem& coloredDatabase() {
  static const MemoryFileSystem files = [] {
    MemoryFileSystem made = soundDatabase();
    addColorMapOf(made, kMemoryDatabasePath, "summer", kFinestLevel,
                  [](std::uint16_t, double column, double row) {
                    const auto a = static_cast<unsigned>(column * 11), b = static_cast<unsigned>(row * 7);
                    return std::array<std::uint8_t, 4>{static_cast<std::uint8_t>(a ^ b),
                                                       static_cast<std::uint8_t>(a + b),
                                                       static_cast<std::uint8_t>(b), 255};
                  });
    return made;
  }();
  return files;
}

Recipe withColors(const std::function<void(ColorParts&)>& change, CheckLevel level = CheckLevel::kDecode) {
  return [change, level](const MemoryFileSystem&) {
    MemoryFileSystem files = coloredDatabase();
    changeColors(files, change);
    return checkedAt(files, level);
  };
}

std::uint8_t& valueAt(std::vector<std::uint8_t>& texels, int i, int j, std::size_t value = 0) {
  return texels.at(4 * static_cast<std::size_t>((j + 1) * kColorTileSide + i + 1) + value);
}

// Changes the red of texel (i, j) of a node.
void nudge(ColorParts& parts, const ColorNode& node, int i, int j, int by = 1) {
  std::vector<std::uint8_t> texels = parts.texels(node);
  std::uint8_t& red = valueAt(texels, i, j);
  red = static_cast<std::uint8_t>(red + by > 255 ? red - by : red + by);
  valueAt(texels, i, j, 3) = 255;
  parts.setTexels(node, texels);
}

// The first node that has, or has not, a neighbour in the east.
const ColorNode& besideOthers(const ColorParts& parts, bool has) {
  for (const ColorNode& node : parts.nodes) {
    if ((parts.beside(node, 1, 0) != nullptr) == has) return node;
  }
  throw std::runtime_error("no such node");
}

// The same tile as another packer might write it: a frame of zstd may store its
// bytes as they are.
std::vector<std::byte> uncompressed(const std::vector<std::byte>& tile) {
  const std::size_t planes = tile.at(0) == std::byte{0} ? 3 : 4;
  std::vector<std::byte> raw(kColorTileBytes / 4 * planes);
  if (!unpackBytes(std::span(tile).subspan(4), raw)) throw std::runtime_error("not a tile");
  ByteWriter writer;
  writer.putBytes(std::span(tile).first(4));
  const auto size = static_cast<std::uint32_t>(raw.size());
  writer.put(std::uint32_t{0xFD2FB528});
  writer.put(std::uint8_t{0xA0});  // one segment, a content size of four bytes
  writer.put(size);
  const std::uint32_t header = 1 | size << 3;  // the last block, raw
  writer.put(static_cast<std::uint16_t>(header));
  writer.put(static_cast<std::uint8_t>(header >> 16));
  writer.putBytes(raw);
  return writer.take();
}

}  // namespace

std::vector<Asset> colorAssets() {
  return {
      {IssueCode::kColorTree, withColors([](ColorParts& parts) { parts.nodes.back().x += 2; }),
       // Blocks may stand in any order.
       withColors([](ColorParts& parts) {
         std::swap(parts.nodes[0].block, parts.nodes[1].block);
         std::swap(parts.tiles[parts.nodes[0].block], parts.tiles[parts.nodes[1].block]);
       })},
      {IssueCode::kColorTile, withColors([](ColorParts& parts) { parts.tiles.back().at(1) = std::byte{1}; }),
       withColors([](ColorParts& parts) { parts.tiles.back() = uncompressed(parts.tiles.back()); })},
      {IssueCode::kColorBorder,
       withColors([](ColorParts& parts) { nudge(parts, besideOthers(parts, true), kColorTileTexels, 77); }),
       // Nobody has a texel there.
       withColors([](ColorParts& parts) { nudge(parts, besideOthers(parts, false), kColorTileTexels, 77); })},
      // Away from the borders, so that no neighbour carries the texel; by so much that the mean of four is
      // another.
      {IssueCode::kColorFilter,
       withColors([](ColorParts& parts) { nudge(parts, parts.nodes.back(), 64, 65, 16); }),
       // A quadrant without a child is not the mean of anything; the coarsest node is below none.
       withColors([](ColorParts& parts) {
         const ColorNode& root = parts.nodes.front();
         ASSERT_NE(root.children, 15);
         const int quadrant = (root.children & 1) == 0   ? 0
                              : (root.children & 2) == 0 ? 1
                              : (root.children & 4) == 0 ? 2
                                                         : 3;
         nudge(parts, root, quadrant == 1 || quadrant == 2 ? 96 : 32, quadrant >= 2 ? 96 : 32);
       })},
  };
}

}  // namespace deltaz
