// Squares of a colour map and the tiles that serve them. Thread-safety: plain values and pure functions.
#pragma once

#include <compare>
#include <cstdint>
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
  // The same ready to be filtered: red, green, blue in linear light, times cover, and cover, 0 .. 1.
  std::vector<float> linear;
};

// Fills `linear` from `texels`.
void makeLinear(TextureTile& tile);

}  // namespace deltaz
