#include "librender/scene/split_cost.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace deltaz {
namespace {

struct Extent {
  PostRange columns, rows;  // of level 0, both ends included
};

Extent extentOf(const GridGeometry& grid, const NodePosition& position) {
  const std::int64_t span = grid.header().leaf_cells << position.level;
  const auto clipped = [&](std::int32_t place, PostRange inside) {
    return PostRange{std::max(place * span, inside.begin), std::min((place + 1) * span, inside.end - 1)};
  };
  return {clipped(position.x, grid.columnsAt(0)), clipped(position.y, grid.rowsAt(0))};
}

// As if a node stood there whose heights are those of `node`.
NodeVolume volumeOfPart(const Node& node, const GridGeometry& grid, const Extent& extent) {
  const std::int64_t columns[] = {extent.columns.begin, extent.columns.end};
  const std::int64_t rows[] = {extent.rows.begin, extent.rows.end};
  const double heights[] = {grid.metres(node.record.minimum_height), grid.metres(node.record.maximum_height)};
  std::array<Vector3, 8> corners;
  Vector3 sum;
  for (std::size_t k = 0; k < corners.size(); ++k) {
    const PostPlace place = grid.placeAt(columns[k & 1], rows[(k >> 1) & 1]);
    corners[k] = place.at(heights[k >> 2]);
    sum = sum + corners[k];
  }
  Node part = node;
  part.centroid = sum * (1.0 / static_cast<double>(corners.size()));
  double radius = 0;
  for (const Vector3& corner : corners) radius = std::max(radius, length(corner - part.centroid));
  // No larger than the node's own, which fits its number.
  part.record.radius = static_cast<decltype(part.record.radius)>(
      std::min(static_cast<double>(node.record.radius), std::ceil(radius / kCentroidUnit)));
  return volumeOf(part, grid, true);
}

}  // namespace

std::uint64_t gridTriangles(const GridGeometry& grid, const NodePosition& position, int level) {
  // Posts of the level under the node, within the area.
  const std::int64_t span = grid.header().leaf_cells << (position.level - level);
  const auto cells = [&](std::int64_t place, PostRange inside) {
    return std::max<std::int64_t>(
        0, std::min((place + 1) * span, inside.end - 1) - std::max(place * span, inside.begin));
  };
  return static_cast<std::uint64_t>(2 * cells(position.x, grid.columnsAt(level)) *
                                    cells(position.y, grid.rowsAt(level)));
}

bool drawsFewerOpened(const Node& node, const GridGeometry& grid,
                      const std::function<bool(const NodeVolume&)>& may_see) {
  const NodePosition position = positionOf(node.record);
  if (position.level == 0) return false;
  const std::uint64_t own = gridTriangles(grid, position, position.level);
  std::uint64_t opened = 0;
  for (int quarter = 0; quarter < 4 && opened < own; ++quarter) {
    const NodePosition part{position.grid, static_cast<std::uint8_t>(position.level - 1),
                            2 * position.x + (quarter & 1), 2 * position.y + (quarter >> 1)};
    const Extent extent = extentOf(grid, part);
    if (extent.columns.size() == 0 || extent.rows.size() == 0) continue;
    if (may_see(volumeOfPart(node, grid, extent))) opened += gridTriangles(grid, part, part.level);
  }
  return opened < own;
}

}  // namespace deltaz
