// Node records against the terrain they stand for.
#include <algorithm>
#include <array>
#include <cmath>
#include <gtest/gtest.h>
#include <numbers>
#include <stdexcept>

#include "libdb/access/grid_geometry.h"
#include "tests/libdb/check/code_assets.h"

namespace deltaz {

namespace {

// The leaf that holds the single void post among its own.
std::uint32_t leafWithVoid(const DatabaseEditor& editor) {
  for (std::uint32_t number = 1; number <= editor.records.size(); ++number) {
    const NodeRecord& node = editor.records[number - 1];
    if (node.type == NodeType::kTerrain && node.level == 0 && (node.flags & kNodeHasVoids) != 0)
      return number;
  }
  throw std::runtime_error("no void");
}

// LOD ranges of a node of level 1 and of its first child.
void setRanges(DatabaseEditor& editor, std::array<float, 2> child, std::array<float, 2> parent) {
  NodeRecord& node = editor.record(innerCoarseNode(editor));
  node.lod_near = parent[0];
  node.lod_far = parent[1];
  NodeRecord& finer = editor.record(node.first_child);
  finer.lod_near = child[0];
  finer.lod_far = child[1];
}

// Turns a leaf's axis a little and makes the cone fit the new axis.
void tiltMeanNormal(DatabaseEditor& editor) {
  NodeRecord& node = editor.record(innerLeaf(editor));
  node.mean_normal[0] = static_cast<std::int16_t>(node.mean_normal[0] + 32);
  const Vector3 axis{static_cast<double>(node.mean_normal[0]), static_cast<double>(node.mean_normal[1]),
                     static_cast<double>(node.mean_normal[2])};
  const TerrainBlock block = editor.block(innerLeaf(editor));
  const GridGeometry geometry(editor.area.grids[0]);
  const int leaf = geometry.header().leaf_cells;
  const auto place = [&](int i, int j) {
    return geometry.placeAt(node.x * leaf + block.first_column + i, node.y * leaf + block.first_row + j)
        .at(geometry.metres(
            block.heights.at(static_cast<std::size_t>((j + 1) * (block.columns + 2) + i + 1))));
  };
  double widest = 0;
  const auto see = [&](const Vector3& a, const Vector3& b, const Vector3& c) {
    const Vector3 normal = cross(b - a, c - a);
    widest = std::max(widest, std::atan2(length(cross(normal, axis)), dot(normal, axis)));
  };
  for (int j = 0; j + 1 < block.rows; ++j) {
    for (int i = 0; i + 1 < block.columns; ++i) {
      see(place(i, j), place(i + 1, j), place(i + 1, j + 1));
      see(place(i, j), place(i + 1, j + 1), place(i, j + 1));
    }
  }
  node.cone_half_angle = static_cast<std::uint16_t>(std::ceil(widest * 65535 / std::numbers::pi));
}

}  // namespace

std::vector<Asset> tileAssets() {
  return {
      {IssueCode::kTileGrid, byEditing([](DatabaseEditor& editor) {
         TerrainBlock block = editor.block(innerLeaf(editor));
         block.quantum = {2, 1};
         editor.setBlock(innerLeaf(editor), block);
       }),
       byEditing(changeAncestorErrors)},
      {IssueCode::kTileHeightRange,
       byEditing([](DatabaseEditor& editor) { editor.record(innerLeaf(editor)).minimum_height -= 1; }),
       // Empty leaves have no range, and their parents do without.
       [](const MemoryFileSystem&) {
         SyntheticGridOptions options;
         options.voids = VoidPattern::kWestHalf;
         options.lowest = 10;
         return checkedAt(buildInMemory(syntheticGrid(options), smallLeaves()));
       }},
      {IssueCode::kTileVoids,
       byEditing([](DatabaseEditor& editor) { editor.record(innerLeaf(editor)).valid_posts -= 1; }),
       byEditing([](DatabaseEditor& editor) {
         ASSERT_EQ(editor.record(leafWithVoid(editor)).flags, kNodeHasVoids);
       })},
      {IssueCode::kTileSphere, byEditing([](DatabaseEditor& editor) {
         NodeRecord& node = editor.record(innerLeaf(editor));
         node.radius -= node.radius / 10;
       }),
       byEditing([](DatabaseEditor& editor) { editor.record(innerLeaf(editor)).radius += 1; })},
      // A facet that leans more than the cone allows: the cone is made narrower.
      {IssueCode::kTileCone,
       byEditing(
           [](DatabaseEditor& editor) {
             NodeRecord& node = editor.record(innerLeaf(editor));
             node.cone_half_angle = static_cast<std::uint16_t>(node.cone_half_angle - 3);
           },
           CheckLevel::kGeometry),
       // One unit wider than needed is what rounding may do.
       byEditing([](DatabaseEditor& editor) { editor.record(innerLeaf(editor)).cone_half_angle += 1; },
                 CheckLevel::kGeometry)},
      // An axis that is off by half a tenth of a degree, in a cone that fits it.
      {IssueCode::kTileNormal, byEditing(tiltMeanNormal, CheckLevel::kGeometry),
       // Off by one in the last place.
       byEditing(
           [](DatabaseEditor& editor) {
             NodeRecord& node = editor.record(innerLeaf(editor));
             node.mean_normal[0] += 1;
             node.cone_half_angle += 1;
           },
           CheckLevel::kGeometry)},
      {IssueCode::kTileLod,
       byEditing(
           [](DatabaseEditor& editor) {
             setRanges(editor, {100, 200}, {50, 60});
           },
           CheckLevel::kGeometry),
       byEditing(
           [](DatabaseEditor& editor) {
             setRanges(editor, {0, 100}, {100, 200});
           },
           CheckLevel::kGeometry)},
  };
}

}  // namespace deltaz
