// One node's terrain, decoded: heights, voids and the ring of neighbours. Plain value; no file behind it.
//
// A cell (i, j) has corners 1 SW (i, j), 2 NW (i, j+1), 3 NE (i+1, j+1), 4 SE (i+1, j) and two faces: bottom
// (1, 4, 3) and top (1, 3, 2), the SW-NE diagonal everywhere (report Fig 62). A face is drawn only if its
// three posts are valid.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace deltaz {

struct TerrainTile {
  int grid = 0;
  int level = 0;
  std::int32_t x = 0, y = 0;                     // node position, as in NodeRecord
  std::int64_t first_column = 0, first_row = 0;  // level-`level` index of post (0, 0)
  int columns = 0, rows = 0;                     // posts, without the ring
  std::vector<std::int32_t> heights;  // (columns + 2) x (rows + 2), quanta, from the ring's south-west corner
  std::vector<std::uint8_t> valid;    // 1 or 0, same shape
  // Index into the grid's sentinels of each void post, same shape; empty if all are 0.
  std::vector<std::uint8_t> void_kinds;

  // Index of post (i, j) in heights and valid; -1 <= i <= columns, -1 <= j <= rows.
  std::size_t index(int i, int j) const {
    return static_cast<std::size_t>(j + 1) * static_cast<std::size_t>(columns + 2) +
           static_cast<std::size_t>(i + 1);
  }
  std::int32_t height(int i, int j) const { return heights[index(i, j)]; }
  bool isValid(int i, int j) const { return valid[index(i, j)] != 0; }
  bool bottomFaceValid(int i, int j) const {
    return isValid(i, j) && isValid(i + 1, j) && isValid(i + 1, j + 1);
  }
  bool topFaceValid(int i, int j) const {
    return isValid(i, j) && isValid(i + 1, j + 1) && isValid(i, j + 1);
  }
};

}  // namespace deltaz
