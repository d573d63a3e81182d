#include "libdb/access/color_map.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <fmt/format.h>

namespace deltaz {

double colorNodeCells(int leaf_cells, int level) {
  return std::ldexp(static_cast<double>(leaf_cells), level);
}

double colorTexelCells(int leaf_cells, int level) {
  return colorNodeCells(leaf_cells, level) / kColorTileTexels;
}

std::int32_t colorNodeAt(double posts, int leaf_cells, int level) {
  const double node = std::floor(posts / colorNodeCells(leaf_cells, level));
  return static_cast<std::int32_t>(std::clamp(node, -2147483648.0, 2147483647.0));
}

std::uint32_t childRecord(const ColorNode& node, int child_number) {
  const unsigned bit = 1u << (child_number - 1);
  if ((node.children & bit) == 0) return 0;
  return node.first_child + static_cast<std::uint32_t>(std::popcount(node.children & (bit - 1)));
}

Result<ColorMap> ColorMap::open(std::unique_ptr<ContainerReader> file, const std::vector<GridHeader>& grids) {
  if (file->blockCount() == 0)
    return invalidError(IssueCode::kColorTree, file->path(), "the colour map has no directory");
  const std::uint32_t last = file->blockCount() - 1;
  DELTAZ_TRY_ASSIGN(const std::vector<std::byte> bytes, file->read(last, BlockType::kColorDirectory));
  ColorMap map;
  DELTAZ_TRY_ASSIGN(map.directory_, decodeColorDirectory(bytes, file->blockCount(),
                                                         fmt::format("{}, block {}", file->path(), last)));
  for (const ColorTree& tree : map.directory_.trees) {
    if (tree.grid >= grids.size())
      return invalidError(IssueCode::kColorTree, file->path(), "a tree is of a grid that is not there");
  }
  for (const GridHeader& grid : grids) map.leaf_cells_.push_back(grid.leaf_cells);
  map.cache_ = std::make_unique<PageCache>();
  map.cache_->pages.resize(last - map.directory_.first_page);
  map.file_ = std::move(file);
  return map;
}

const ColorTree* ColorMap::treeOf(std::uint16_t grid) const {
  const auto found = std::find_if(directory_.trees.begin(), directory_.trees.end(),
                                  [&](const ColorTree& tree) { return tree.grid == grid; });
  return found == directory_.trees.end() ? nullptr : &*found;
}

Result<ColorNode> ColorMap::record(std::uint32_t number) const {
  if (number == 0 || number > directory_.node_count) {
    return invalidError(IssueCode::kColorTree, file_->path(),
                        fmt::format("there is no record {}; the last is {}", number, directory_.node_count));
  }
  const std::uint32_t page_number = (number - 1) / kColorNodesPerPage;
  const std::size_t slot = (number - 1) % kColorNodesPerPage;
  {
    const std::lock_guard guard(cache_->mutex);
    if (const auto& page = cache_->pages[page_number]) return (*page)[slot];
  }
  const std::uint32_t block = directory_.first_page + page_number;
  DELTAZ_TRY_ASSIGN(const std::vector<std::byte> bytes, file_->read(block, BlockType::kColorPage));
  DELTAZ_TRY_ASSIGN(std::vector<ColorNode> nodes,
                    decodeColorPage(bytes, fmt::format("{}, block {}", file_->path(), block)));
  const std::size_t expected = std::min<std::size_t>(
      kColorNodesPerPage, directory_.node_count - std::size_t{page_number} * kColorNodesPerPage);
  if (nodes.size() != expected) {
    return invalidError(IssueCode::kColorTree, file_->path(),
                        fmt::format("page {} has {} records, not {}", page_number, nodes.size(), expected));
  }
  const ColorNode result = nodes[slot];
  const std::lock_guard guard(cache_->mutex);
  cache_->pages[page_number] = std::make_shared<const std::vector<ColorNode>>(std::move(nodes));
  return result;
}

Result<std::optional<ColorNode>> ColorMap::nodeAt(std::uint16_t grid, double column, double row,
                                                  int level) const {
  const ColorTree* tree = treeOf(grid);
  if (tree == nullptr) return std::optional<ColorNode>{};
  const int leaf = leaf_cells_[grid];
  const auto isAt = [&](const ColorNode& node, int at_level) {
    return node.grid == grid && node.level == at_level && node.x == colorNodeAt(column, leaf, at_level) &&
           node.y == colorNodeAt(row, leaf, at_level);
  };
  std::optional<ColorNode> found;
  for (std::uint32_t root = 0; root < tree->root_count && !found; ++root) {
    DELTAZ_TRY_ASSIGN(const ColorNode node, record(tree->first_root + root));
    if (isAt(node, tree->coarsest_level)) found = node;
  }
  if (!found) return found;
  // Every step goes one level down, so a damaged file cannot lead in circles.
  while (found->level > level) {
    const bool east = (colorNodeAt(column, leaf, found->level - 1) & 1) != 0;
    const bool north = (colorNodeAt(row, leaf, found->level - 1) & 1) != 0;
    const std::uint32_t child = childRecord(*found, north ? (east ? 3 : 4) : (east ? 2 : 1));
    if (child == 0) break;
    const int below = found->level - 1;
    DELTAZ_TRY_ASSIGN(const ColorNode node, record(child));
    if (!isAt(node, below)) {
      return invalidError(IssueCode::kColorTree, file_->path(),
                          fmt::format("record {} does not stand where its parent says", child));
    }
    found = node;
  }
  return found;
}

Result<std::vector<std::uint8_t>> ColorMap::tile(const ColorNode& node) const {
  DELTAZ_TRY_ASSIGN(const std::vector<std::byte> bytes, file_->read(node.block, BlockType::kColorTile));
  return decodeColorTile(bytes, fmt::format("{}, block {}", file_->path(), node.block));
}

}  // namespace deltaz
