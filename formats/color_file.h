// Colour files, one per colour map: a pyramid of texels over each grid of the area, cut into square tiles,
// one for each node of a quadtree that is the terrain's own, continued below its leaves and above its
// coarsest nodes. Specified in color_file.md.
//
// Node (x, y) of level k covers the cells x .. x + 1 times leaf_cells * 2^k of its grid, k of either sign,
// and has kColorTileTexels texels a side, so texels of one level lie at global multiples and each is the
// mean, in linear light, of four of the level below. The mip map of a node is its own tile and those of the
// nodes above it: nothing is stored twice, and there is nothing at a border that could differ.
//
// Source: report 6.4 (mip maps), 5.1.4.2.2 (nodes). Record numbers start at 1. Errors: kInvalid with
// kColorTree or kColorTile. Thread-safety: plain values and pure functions.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "formats/error.h"

namespace deltaz {

inline constexpr int kColorTileTexels = 128;
// A tile carries its neighbours' outermost texels, so that interpolation needs no other tile.
inline constexpr int kColorTileSide = kColorTileTexels + 2;
inline constexpr std::size_t kColorTileBytes = std::size_t{4} * kColorTileSide * kColorTileSide;
inline constexpr std::uint32_t kColorNodesPerPage = 128;
inline constexpr int kLowestColorLevel = -40, kHighestColorLevel = 60;

struct ColorNode {
  std::uint16_t grid = 0;
  std::int8_t level = 0;
  std::uint8_t children = 0;  // bit n - 1 is set if child number n is there: 1 SW, 2 SE, 3 NE, 4 NW
  std::int32_t x = 0, y = 0;
  std::uint32_t first_child =
      0;                    // record number; the others follow it in the order of their numbers; 0 for none
  std::uint32_t block = 0;  // of the tile
  bool operator==(const ColorNode&) const = default;
};

// The tree over one grid: records first_root .. first_root + root_count - 1 are its coarsest nodes, all of
// one level.
struct ColorTree {
  std::uint16_t grid = 0;
  std::uint32_t first_root = 1, root_count = 1;  // at most 4
  std::int8_t coarsest_level = 0, finest_level = 0;
  bool operator==(const ColorTree&) const = default;
};

// The last block of a colour file: tiles come first, then pages of records, then this.
struct ColorDirectory {
  std::uint32_t node_count = 0;
  std::uint32_t first_page = 0;  // block number of the first page of records
  std::vector<ColorTree> trees;  // in the order of their grids, at most one for each
  bool operator==(const ColorDirectory&) const = default;
};

std::vector<std::byte> encodeColorDirectory(const ColorDirectory& directory);
// `blocks`: blocks of the file, the directory's own included. Everything that follows from it is checked.
Result<ColorDirectory> decodeColorDirectory(std::span<const std::byte> bytes, std::uint32_t blocks,
                                            const std::string& where);

std::vector<std::byte> encodeColorPage(std::span<const ColorNode> nodes);
Result<std::vector<ColorNode>> decodeColorPage(std::span<const std::byte> bytes, const std::string& where);

// kColorTileBytes of texels: red, green, blue (sRGB codes) and cover (255: all of the texel has a colour),
// row by row from the south-west, the border included: texel (i, j) of the node stands at row j + 1, column i
// + 1. Without cover a texel's colour is 0.
std::vector<std::byte> encodeColorTile(std::span<const std::uint8_t> texels);
Result<std::vector<std::uint8_t>> decodeColorTile(std::span<const std::byte> bytes, const std::string& where);

}  // namespace deltaz
