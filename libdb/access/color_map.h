// A colour map of a database: finds the node that holds a place and reads its texels. Only the pages and
// tiles that are asked for are read, and pages only once.
//
// Errors: whatever reading reports; kColorTree where records contradict each other. Thread-safety: const
// members from any thread.
#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include "formats/area.h"
#include "formats/color_file.h"
#include "formats/container.h"

namespace deltaz {

// Cells of level 0 along the side of a node, and of one texel, of colour level `level`.
double colorNodeCells(int leaf_cells, int level);
double colorTexelCells(int leaf_cells, int level);
// The node of level `level` whose square holds a coordinate (level-0 posts, along either axis); squares hold
// their west and south ends.
std::int32_t colorNodeAt(double posts, int leaf_cells, int level);

class ColorMap {
 public:
  static Result<ColorMap> open(std::unique_ptr<ContainerReader> file, const std::vector<GridHeader>& grids);

  const ColorDirectory& directory() const { return directory_; }
  // Cells along the side of a node of level 0. Pre: the area has the grid.
  int leafCells(std::uint16_t grid) const { return leaf_cells_[grid]; }
  // Nothing if the map has no texels over this grid.
  const ColorTree* treeOf(std::uint16_t grid) const;

  // The node that holds (column, row), in level-0 posts, at `level`, or the finest coarser one where the map
  // is not so fine; levels above the coarsest give the coarsest. Nothing where the map has no texels.
  Result<std::optional<ColorNode>> nodeAt(std::uint16_t grid, double column, double row, int level) const;
  // One record by number, 1 <= number <= directory().node_count.
  Result<ColorNode> record(std::uint32_t number) const;
  // A node's texels, as decodeColorTile gives them.
  Result<std::vector<std::uint8_t>> tile(const ColorNode& node) const;

  const ContainerReader& file() const { return *file_; }

 private:
  ColorMap() = default;
  std::unique_ptr<ContainerReader> file_;
  std::vector<int> leaf_cells_;  // of each grid
  ColorDirectory directory_;
  struct PageCache {
    std::mutex mutex;
    std::vector<std::shared_ptr<const std::vector<ColorNode>>> pages;
  };
  std::unique_ptr<PageCache> cache_;
};

// The number of the child `child_number` (1 to 4) of a node, 0 if it is not there.
std::uint32_t childRecord(const ColorNode& node, int child_number);

}  // namespace deltaz
