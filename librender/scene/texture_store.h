// The memory manager of colour (report 5.6): the tiles of a colour map that a frame needs, read at once.
//
// What a pixel asks for is a square: the place of a node of some level, whether or not the map has that node.
// Where it has none, the finest coarser node that holds the place serves; all places of a square share it.
//
// Thread-safety: const members from any thread. A TextureReader belongs to one thread.
#pragma once

#include <array>
#include <compare>
#include <cstdint>
#include <optional>
#include <vector>

#include "libdb/access/color_map.h"

namespace deltaz {

// Node (x, y) of a level of a grid, as of color_file.h.
struct TextureSquare {
  std::uint16_t grid = 0;
  std::int8_t level = 0;
  std::int32_t x = 0, y = 0;
  auto operator<=>(const TextureSquare&) const = default;
};

struct TextureTile {
  TextureSquare square;              // the node's own
  int leaf_cells = 0;                // of its grid
  std::vector<std::uint8_t> texels;  // as decodeColorTile gives them
};

class TextureStore {
 public:
  // Without tiles: every square is empty.
  TextureStore() = default;
  // Reads what serves `squares`, which may stand in any order and more than once. Runs on the threads of the
  // caller's TBB arena. Errors: whatever reading reports; of several, the first in the order of the squares.
  static Result<TextureStore> read(const ColorMap& map, std::vector<TextureSquare> squares);

  // The tile that serves a square, nullptr where the map has no texels. Pre: the square was asked for.
  const TextureTile* find(const TextureSquare& square) const;
  std::size_t tileCount() const { return tiles_.size(); }

 private:
  static constexpr std::uint32_t kNoTile = 0xffffffff;
  std::vector<TextureSquare> squares_;  // sorted
  std::vector<std::uint32_t> tile_of_;  // by square: index in tiles_, or kNoTile
  std::vector<TextureTile> tiles_;
};

// Looks tiles up in a store; neighbouring pixels mostly want the tiles of the pixel before.
class TextureReader {
 public:
  explicit TextureReader(const TextureStore& store) : store_(store) {}
  const TextureTile* find(const TextureSquare& square);

 private:
  struct Last {
    TextureSquare square;
    const TextureTile* tile = nullptr;
  };
  const TextureStore& store_;
  std::array<std::optional<Last>, 2> last_;  // a pixel asks for two levels, one of them even
};

}  // namespace deltaz
