#include "librender/scene/seam_index.h"

#include <algorithm>
#include <unordered_set>

#include "libdb/access/seam_geometry.h"

namespace deltaz {
namespace {

// The leaf that holds a cell; cells beyond the last are taken for the last, whose leaf has their posts.
NodePosition leafOf(const GridGeometry& geometry, std::uint16_t grid, std::int64_t column, std::int64_t row) {
  const std::int64_t leaf_cells = geometry.header().leaf_cells;
  const auto clamped = [](std::int64_t index, PostRange posts) { return std::min(index, posts.end - 2); };
  return {grid, 0, static_cast<std::int32_t>(floorDivide(clamped(column, geometry.columnsAt(0)), leaf_cells)),
          static_cast<std::int32_t>(floorDivide(clamped(row, geometry.rowsAt(0)), leaf_cells))};
}

// Cells of a leaf inside the grid.
std::int64_t cellsOf(const GridGeometry& geometry, const NodePosition& leaf) {
  const PostRange columns = geometry.nodePosts(geometry.columnsAt(0), leaf.x);
  const PostRange rows = geometry.nodePosts(geometry.rowsAt(0), leaf.y);
  return std::max<std::int64_t>(0, columns.size() - 1) * std::max<std::int64_t>(0, rows.size() - 1);
}

// Leaves of a grid below a node.
std::int64_t leavesBelow(const GridGeometry& geometry, const NodePosition& node) {
  const auto count = [&](PostRange leaves, std::int32_t at) {
    const std::int64_t begin = static_cast<std::int64_t>(at) << node.level,
                       end = static_cast<std::int64_t>(at + 1) << node.level;
    return std::max<std::int64_t>(0, std::min(end, leaves.end) - std::max(begin, leaves.begin));
  };
  return count(geometry.nodeColumnsAt(0), node.x) * count(geometry.nodeRowsAt(0), node.y);
}

}  // namespace

SeamIndex::SeamIndex(const Database& database) : seams_(&database.seams()) {
  if (seams_->empty()) return;
  for (int grid = 0; grid < database.gridCount(); ++grid) grids_.push_back(database.grid(grid));
  for (std::uint32_t s = 0; s < seams_->size(); ++s) {
    const Seam& seam = (*seams_)[s];
    for (const SeamSide side : {SeamSide::kUpper, SeamSide::kLower}) {
      const std::uint16_t grid = gridOf(seam, side);
      for (const ReplacedFace& face : seam.replacedOf(side)) {
        LeafSeams& leaf = leaves_[leafOf(grids_[grid], grid, face.column, face.row)];
        leaf.replaced.push_back({s, face});
        for (std::uint32_t f = 0; f < face.face_count; ++f) {
          for (const std::uint32_t v : seam.faces[face.first_face + f]) {
            const SeamVertex& vertex = seam.vertices[v];
            const std::uint16_t of = gridOf(seam, vertex.side);
            const NodePosition partner = leafOf(grids_[of], of, vertex.column, vertex.row);
            if (std::find(leaf.partners.begin(), leaf.partners.end(), partner) == leaf.partners.end())
              leaf.partners.push_back(partner);
          }
        }
      }
    }
    for (const CellRun& run : seam.runs) {
      const std::int64_t leaf_cells = grids_[seam.lower].header().leaf_cells;
      for (std::int64_t begin = run.begin; begin < run.end;) {
        const std::int64_t end = std::min(run.end, (floorDivide(begin, leaf_cells) + 1) * leaf_cells);
        leaves_[leafOf(grids_[seam.lower], seam.lower, begin, run.row)].removed.push_back(
            {run.row, begin, end});
        begin = end;
      }
    }
  }
  // Faces of other leaves stand on posts of partners, which must be at hand whatever is left of them.
  std::unordered_set<NodePosition, NodePositionHash> needed;
  for (const auto& [position, leaf] : leaves_) needed.insert(leaf.partners.begin(), leaf.partners.end());
  for (const NodePosition& position : needed) leaves_.try_emplace(position);
  for (const auto& [position, leaf] : leaves_) {
    const GridGeometry& geometry = grids_[position.grid];
    std::int64_t gone = 0;
    for (const CellRun& run : leaf.removed) gone += run.end - run.begin;
    const bool removed = gone == cellsOf(geometry, position) && !needed.contains(position);
    NodePosition node = position;
    for (; node.level < geometry.header().level_count; ++node.level, node.x >>= 1, node.y >>= 1) {
      Counts& counts = touched_[node];
      ++counts.touched;
      counts.removed += removed ? 1 : 0;
    }
  }
}

SeamState SeamIndex::stateOf(const NodePosition& position) const {
  const auto found = touched_.find(position);
  if (found == touched_.end()) return SeamState::kFree;
  return found->second.removed == leavesBelow(grids_[position.grid], position) ? SeamState::kRemoved
                                                                               : SeamState::kTouched;
}

const LeafSeams* SeamIndex::leaf(const NodePosition& position) const {
  const auto found = leaves_.find(position);
  return found == leaves_.end() ? nullptr : &found->second;
}

std::vector<std::uint8_t> SeamIndex::replacedFaces(const TerrainTile& tile) const {
  if (tile.level != 0) return {};
  const LeafSeams* const seams = leaf({static_cast<std::uint16_t>(tile.grid), 0, tile.x, tile.y});
  if (seams == nullptr || tile.columns < 2 || tile.rows < 2) return {};
  std::vector<std::uint8_t> replaced(
      static_cast<std::size_t>(tile.columns - 1) * static_cast<std::size_t>(tile.rows - 1) * 2, 0);
  const auto cell = [&](std::int64_t column, std::int64_t row) {
    return static_cast<std::size_t>((row - tile.first_row) * (tile.columns - 1) +
                                    (column - tile.first_column));
  };
  for (const LeafReplacement& replacement : seams->replaced) {
    const ReplacedFace& face = replacement.face;
    replaced[cell(face.column, face.row) * 2 + (face.top ? 1 : 0)] = 1;
  }
  for (const CellRun& run : seams->removed) {
    for (std::int64_t column = run.begin; column < run.end; ++column)
      replaced[cell(column, run.row) * 2] = replaced[cell(column, run.row) * 2 + 1] = 1;
  }
  return replaced;
}

}  // namespace deltaz
