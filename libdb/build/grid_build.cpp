#include "libdb/build/grid_build.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <fmt/format.h>
#include <limits>
#include <utility>

#include "libdb/access/plan_shape.h"
#include "libdb/build/coverage_error.h"
#include "libdb/build/facet_error.h"

namespace deltaz {

namespace {

GridHeader preparedHeader(const RawGrid& grid, int leaf_cells) {
  GridHeader header = grid.header;
  header.leaf_cells = leaf_cells;
  header.normal_exponent = 2;
  header.level_count = planPyramid(GridGeometry(header)).level_count;
  return header;
}

}  // namespace

GridBuild::GridBuild(const RawGrid& grid, int leaf_cells)
    : grid_(grid),
      geometry_(preparedHeader(grid, leaf_cells), grid.patches),
      plan_(planPyramid(geometry_)),
      facts_(plan_.nodes.size()),
      between_posts_(geometry_) {}

TerrainTile GridBuild::tileOf(std::size_t node) const {
  const PlannedNode& planned = plan_.nodes[node];
  return cutTile(grid_, geometry_, planned.level, planned.x, planned.y);
}

void GridBuild::measureTiles(WorkerPool& workers) {
  workers.forEach(plan_.nodes.size(),
                  [&](std::size_t i) { facts_[i].summary = summarizeTile(tileOf(i), geometry_); });
  for (std::size_t i = 0; i < plan_.nodes.size(); ++i) {
    const PlannedNode& node = plan_.nodes[i];
    between_posts_.addSteepest(node.level, node.x, node.y, facts_[i].summary.steepest);
  }
}

void GridBuild::measureErrors(WorkerPool& workers) {
  const std::size_t begin = levelBegin(0);
  workers.forEach(levelEnd(0) - begin, [&](std::size_t i) {
    const PlannedNode& leaf = plan_.nodes[begin + i];
    facts_[begin + i].leaf_errors = leafErrors(grid_, geometry_, plan_.level_count, leaf.x, leaf.y);
  });
  // Every ancestor of a leaf takes the leaf's errors against its own level.
  for (std::size_t leaf = begin; leaf < levelEnd(0); ++leaf) {
    std::size_t ancestor = leaf;
    for (const AncestorError& error : facts_[leaf].leaf_errors) {
      ancestor = plan_.nodes[ancestor].parent;
      NodeFacts& facts = facts_[ancestor];
      facts.maximum_error = std::max(facts.maximum_error, error.maximum);
      facts.sum_of_squares += static_cast<double>(error.sum_of_squares);
      facts.compared_posts += error.posts;
    }
  }
}

void GridBuild::measureCoverage(WorkerPool& workers) {
  // Where no post below is void the regions are rectangles, and nothing needs to be looked at.
  std::vector<std::uint8_t> voids_below(plan_.nodes.size(), 0);
  for (std::size_t i = plan_.nodes.size(); i-- > 0;) {
    if (plan_.nodes[i].level == 0) voids_below[i] = facts_[i].summary.void_posts > 0 ? 1 : 0;
    if (plan_.nodes[i].parent != kNoNode && voids_below[i] != 0) voids_below[plan_.nodes[i].parent] = 1;
  }
  workers.forEach(plan_.nodes.size(), [&](std::size_t i) {
    const PlannedNode& node = plan_.nodes[i];
    facts_[i].coverage_error =
        node.level == 0 ? 0
                        : coverageError(grid_, geometry_, node.level, node.x, node.y, voids_below[i] != 0);
  });
}

// The leaf that has cell (column, row), from the coarsest level down.
std::size_t GridBuild::leafOf(std::int64_t column, std::int64_t row) const {
  const std::int64_t cells = geometry_.header().leaf_cells;
  const std::int64_t x = floorDivide(column, cells), y = floorDivide(row, cells);
  const auto isOver = [&](const PlannedNode& node) {
    return node.x == x >> node.level && node.y == y >> node.level;
  };
  std::size_t node = levelBegin(plan_.level_count - 1);
  while (!isOver(plan_.nodes[node])) ++node;
  while (plan_.nodes[node].level > 0) {
    node = plan_.nodes[node].first_child;
    while (!isOver(plan_.nodes[node])) ++node;
  }
  return node;
}

void GridBuild::includeSeamFace(std::int64_t column, std::int64_t row, const std::array<Vector3, 3>& face) {
  includeFace(facts_[leafOf(column, row)].summary.bounds, face);
}

// Children stand behind their parents.
void GridBuild::gatherUpwards() {
  for (std::size_t i = plan_.nodes.size(); i-- > 0;) {
    const PlannedNode& node = plan_.nodes[i];
    if (node.child_count == 0) continue;
    std::vector<NodeBounds> children;
    for (std::uint32_t c = 0; c < node.child_count; ++c)
      children.push_back(facts_[node.first_child + c].summary.bounds);
    includeChildren(facts_[i].summary.bounds, children);
  }
  std::vector<NodeBounds> top;
  for (std::size_t i = levelBegin(plan_.level_count - 1); i < levelEnd(plan_.level_count - 1); ++i)
    top.push_back(facts_[i].summary.bounds);
  includeChildren(bounds_, top);
}

Status GridBuild::checkExtent(const std::array<std::int64_t, 3>& area) const {
  const auto fits = [](const NodeBounds& bounds, const std::array<std::int64_t, 3>& parent) {
    if (bounds.empty) return true;
    if (bounds.radius == std::numeric_limits<std::uint32_t>::max()) return false;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::int64_t offset = bounds.centroid[k] - parent[k];
      if (offset < INT32_MIN || offset > INT32_MAX) return false;
    }
    return true;
  };
  bool all = fits(bounds_, area);
  for (std::size_t i = 0; i < facts_.size() && all; ++i) {
    const std::uint32_t parent = plan_.nodes[i].parent;
    all = fits(facts_[i].summary.bounds,
               parent == kNoNode ? bounds_.centroid : facts_[parent].summary.bounds.centroid);
  }
  if (all) return Success{};
  return invalidError(IssueCode::kNone, "sources", "the area is too large for a database",
                      fmt::format("its ground, or its heights of {} to {} m, reach farther than {} m",
                                  geometry_.metres(bounds_.minimum_height),
                                  geometry_.metres(bounds_.maximum_height), INT32_MAX * kCentroidUnit),
                      "Check the unit of the heights, or cut the area (--bounds)");
}

double GridBuild::chordSagOfCoarsest() const {
  return chordSag(geometry_, plan_.level_count - 1, geometry_.metres(bounds_.maximum_height));
}

double GridBuild::largestErrorOfCoarsest() const {
  std::uint32_t largest = 0;
  for (std::size_t i = levelBegin(plan_.level_count - 1); i < levelEnd(plan_.level_count - 1); ++i)
    largest = std::max(largest, facts_[i].maximum_error);
  return static_cast<double>(largest) * kErrorUnit;
}

std::vector<std::byte> GridBuild::encodeBlock(std::size_t index) const {
  const PlannedNode& node = plan_.nodes[index];
  TerrainTile tile = tileOf(index);
  const GridHeader& header = geometry_.header();
  TerrainBlock block;
  block.columns = static_cast<std::uint16_t>(tile.columns);
  block.rows = static_cast<std::uint16_t>(tile.rows);
  block.first_column =
      static_cast<std::uint16_t>(tile.first_column - std::int64_t{node.x} * header.leaf_cells);
  block.first_row = static_cast<std::uint16_t>(tile.first_row - std::int64_t{node.y} * header.leaf_cells);
  const double scale = static_cast<double>(std::int64_t{1} << node.level);
  block.spacing_x = header.x_axis.spacing * scale;
  block.spacing_y = header.y_axis.spacing * scale;
  block.quantum = header.quantum;
  block.heights = std::move(tile.heights);
  block.valid = std::move(tile.valid);
  block.void_kinds = std::move(tile.void_kinds);
  block.ancestors = facts_[index].leaf_errors;
  return encodeTerrainBlock(block);
}

NodeRecord GridBuild::recordOf(std::size_t index) const {
  const PlannedNode& node = plan_.nodes[index];
  const NodeFacts& facts = facts_[index];
  NodeRecord record;
  record.type = NodeType::kTerrain;
  record.level = static_cast<std::uint8_t>(node.level);
  record.child_number = node.child_number;
  record.x = node.x;
  record.y = node.y;
  record.valid_posts = facts.summary.valid_posts;
  if (facts.summary.void_posts > 0) record.flags |= kNodeHasVoids;
  const NodeBounds& parent = node.parent == kNoNode ? bounds_ : facts_[node.parent].summary.bounds;
  putBounds(record, facts.summary.bounds, parent.centroid);
  putErrors(record, node, facts);
  return record;
}

void GridBuild::putErrors(NodeRecord& record, const PlannedNode& node, const NodeFacts& facts) const {
  record.coverage_error = facts.coverage_error;
  if (node.level == 0 || facts.summary.bounds.empty) {
    record.geometric_error = record.coverage_error = record.rms_error = 0;
    return;
  }
  // A node that draws nothing has no error that could be bounded.
  if (facts.summary.facets == 0) return;
  const double slack = between_posts_.slack(node.level, node.x, node.y) / kErrorUnit;
  const double error = std::ceil(static_cast<double>(facts.maximum_error) + slack);
  if (error < static_cast<double>(kUnknownError)) record.geometric_error = static_cast<std::uint32_t>(error);
  if (facts.compared_posts > 0) {
    const double rms = std::sqrt(facts.sum_of_squares / static_cast<double>(facts.compared_posts));
    record.rms_error =
        static_cast<std::uint32_t>(std::min(std::round(rms), static_cast<double>(kUnknownError - 1)));
  }
}

void putBounds(NodeRecord& record, const NodeBounds& bounds,
               const std::array<std::int64_t, 3>& parent_centroid) {
  if (bounds.empty) {
    record.flags |= kNodeIsEmpty;
    return;
  }
  for (std::size_t k = 0; k < 3; ++k)
    record.centroid_offset[k] = static_cast<std::int32_t>(bounds.centroid[k] - parent_centroid[k]);
  record.radius = bounds.radius;
  record.minimum_height = bounds.minimum_height;
  record.maximum_height = bounds.maximum_height;
  record.mean_normal = bounds.mean_normal;
  record.cone_half_angle = bounds.cone_half_angle;
}

}  // namespace deltaz
