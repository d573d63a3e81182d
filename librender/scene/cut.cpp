#include "librender/scene/cut.h"

#include <algorithm>
#include <bit>

namespace deltaz {

NodePosition beyond(const NodePosition& position, Side side) {
  NodePosition result = position;
  switch (side) {
    case Side::kSouth:
      --result.y;
      break;
    case Side::kEast:
      ++result.x;
      break;
    case Side::kNorth:
      ++result.y;
      break;
    case Side::kWest:
      --result.x;
      break;
  }
  return result;
}

CutIndex::CutIndex(const Database& database, const std::vector<CutNode>& nodes) {
  for (int grid = 0; grid < database.gridCount(); ++grid) {
    const GridHeader& header = database.grid(grid).header();
    grids_.push_back({header.level_count, header.leaf_cells});
  }
  places_.resize(std::bit_ceil(std::max<std::size_t>(2, 2 * nodes.size())));
  const std::size_t mask = places_.size() - 1;
  for (std::size_t n = 0; n < nodes.size(); ++n) {
    const NodePosition position = positionOf(nodes[n].node.record);
    std::size_t slot = NodePositionHash()(position) & mask;
    while (places_[slot].node != kNone && !(places_[slot].position == position)) slot = (slot + 1) & mask;
    if (places_[slot].node == kNone) places_[slot] = {position, static_cast<std::uint32_t>(n)};
  }
}

std::uint32_t CutIndex::at(const NodePosition& position) const {
  const std::size_t mask = places_.size() - 1;
  std::size_t slot = NodePositionHash()(position) & mask;
  while (places_[slot].node != kNone && !(places_[slot].position == position)) slot = (slot + 1) & mask;
  return places_[slot].node;
}

std::uint32_t CutIndex::holding(std::uint16_t grid, std::int64_t column, std::int64_t row) const {
  const Grid& of_grid = grids_[grid];
  NodePosition position{grid, 0, static_cast<std::int32_t>(floorDivide(column, of_grid.leaf_cells)),
                        static_cast<std::int32_t>(floorDivide(row, of_grid.leaf_cells))};
  for (; position.level < of_grid.levels; ++position.level, position.x >>= 1, position.y >>= 1) {
    if (const std::uint32_t found = at(position); found != kNone) return found;
  }
  return kNone;
}

std::uint32_t CutIndex::acrossWhole(const NodePosition& position, Side side) const {
  NodePosition across = beyond(position, side);
  for (; across.level < grids_[position.grid].levels; ++across.level, across.x >>= 1, across.y >>= 1) {
    if (const std::uint32_t found = at(across); found != kNone) return found;
  }
  return kNone;
}

void CutIndex::postsAcross(const NodePosition& position, Side side, std::int64_t from, std::int64_t to,
                           std::vector<std::int64_t>& posts) const {
  posts.clear();
  const auto facing = static_cast<Side>((static_cast<int>(side) + 2) % 4);
  addPosts(beyond(position, side), facing, from, to, posts);
  // Two nodes that meet name the post between them twice.
  posts.erase(std::unique(posts.begin(), posts.end()), posts.end());
}

void CutIndex::appendTouching(const NodePosition& position, std::vector<std::uint32_t>& nodes) const {
  for (const Side side : kSides) {
    if (const std::uint32_t whole = acrossWhole(position, side); whole != kNone) {
      nodes.push_back(whole);
    } else {
      appendFiner(beyond(position, side), static_cast<Side>((static_cast<int>(side) + 2) % 4), nodes);
    }
  }
  const std::int64_t span = grids_[position.grid].leaf_cells << position.level;
  for (int corner = 0; corner < 4; ++corner) {
    const std::int64_t column = position.x * span + ((corner & 1) != 0 ? span : -1),
                       row = position.y * span + ((corner & 2) != 0 ? span : -1);
    if (const std::uint32_t node = holding(position.grid, column, row); node != kNone) nodes.push_back(node);
  }
}

// `facing` is the side of `position` that they lie on.
void CutIndex::appendFiner(const NodePosition& position, Side facing,
                           std::vector<std::uint32_t>& nodes) const {
  if (const std::uint32_t node = at(position); node != kNone) {
    nodes.push_back(node);
    return;
  }
  if (position.level == 0) return;
  const bool along_x = facing == Side::kSouth || facing == Side::kNorth;
  for (std::int32_t half = 0; half < 2; ++half) {
    NodePosition child{position.grid, static_cast<std::uint8_t>(position.level - 1), position.x * 2,
                       position.y * 2};
    (along_x ? child.x : child.y) += half;
    if (facing == Side::kEast) ++child.x;
    if (facing == Side::kNorth) ++child.y;
    appendFiner(child, facing, nodes);
  }
}

// `facing` is the side of `position` that the posts lie on.
void CutIndex::addPosts(const NodePosition& position, Side facing, std::int64_t from, std::int64_t to,
                        std::vector<std::int64_t>& posts) const {
  const bool along_x = facing == Side::kSouth || facing == Side::kNorth;
  const std::int64_t step = std::int64_t{1} << position.level;
  const std::int64_t span = grids_[position.grid].leaf_cells * step;
  const std::int64_t begin = (along_x ? position.x : position.y) * span;
  if (begin >= to || begin + span <= from) return;
  if (at(position) != kNone) {
    for (std::int64_t post = std::max(begin, ceilDivide(from + 1, step) * step);
         post <= begin + span && post < to; post += step)
      posts.push_back(post);
    return;
  }
  if (position.level == 0) return;
  for (std::int32_t half = 0; half < 2; ++half) {
    NodePosition child{position.grid, static_cast<std::uint8_t>(position.level - 1), position.x * 2,
                       position.y * 2};
    (along_x ? child.x : child.y) += half;
    if (facing == Side::kEast) ++child.x;
    if (facing == Side::kNorth) ++child.y;
    addPosts(child, facing, from, to, posts);
  }
}

}  // namespace deltaz
