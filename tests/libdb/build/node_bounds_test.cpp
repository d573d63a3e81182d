#include "libdb/build/node_bounds.h"

#include <cmath>
#include <gtest/gtest.h>
#include <limits>

#include "libdb/access/database.h"
#include "tests/support/synthetic_grid.h"

namespace deltaz {
namespace {

// Every post and facet below a node lies in its sphere, height range and cone, at every level.
void expectContainment(const Database& database, const Node& node, std::vector<Node>& path) {
  path.push_back(node);
  if (node.record.type == NodeType::kTerrain) {
    const GridGeometry& geometry = database.grid(node.record.grid);
    const Result<TerrainTile> tile = database.terrain(node);
    ASSERT_TRUE(tile.ok());
    const TerrainTile& t = tile.value();
    const auto rows = geometry.rowConstantsOf(t.level, {t.first_row, t.first_row + t.rows});
    const auto columns = geometry.columnConstantsOf(t.level, {t.first_column, t.first_column + t.columns});
    const auto place = [&](int i, int j) {
      return earthCentred(rows[static_cast<std::size_t>(j)], columns[static_cast<std::size_t>(i)],
                          geometry.metres(t.height(i, j)));
    };
    for (const Node& ancestor : path) {
      const Vector3 axis = unpackNormal(ancestor.record.mean_normal);
      const double cosine = std::cos(coneAngle(ancestor.record.cone_half_angle));
      for (int j = 0; j < t.rows; ++j) {
        for (int i = 0; i < t.columns; ++i) {
          if (!t.isValid(i, j)) continue;
          ASSERT_LE(length(place(i, j) - ancestor.centroid), ancestor.radius());
          if (ancestor.record.type == NodeType::kTerrain) {
            ASSERT_GE(t.height(i, j), ancestor.record.minimum_height);
            ASSERT_LE(t.height(i, j), ancestor.record.maximum_height);
          }
          if (i + 1 >= t.columns || j + 1 >= t.rows) continue;
          if (t.bottomFaceValid(i, j)) {
            const Vector3 normal =
                normalized(cross(place(i + 1, j) - place(i, j), place(i + 1, j + 1) - place(i, j)));
            ASSERT_GE(dot(normal, axis), cosine - 1e-12);
          }
          if (t.topFaceValid(i, j)) {
            const Vector3 normal =
                normalized(cross(place(i + 1, j + 1) - place(i, j), place(i, j + 1) - place(i, j)));
            ASSERT_GE(dot(normal, axis), cosine - 1e-12);
          }
        }
      }
    }
  }
  const Result<std::vector<Node>> children = database.children(node);
  ASSERT_TRUE(children.ok());
  for (const Node& child : children.value()) expectContainment(database, child, path);
  path.pop_back();
}

TEST(NodeBounds, spheres_ranges_and_cones_hold_everything_below) {
  for (const double south : {-0.4, 43.0, 88.9}) {
    SyntheticGridOptions options;
    options.south = south;
    options.voids = VoidPattern::kHole;
    const MemoryFileSystem files = buildInMemory(syntheticGrid(options), {.leaf_cells = 16});
    Result<Database> database = Database::open(files, kMemoryDatabasePath);
    ASSERT_TRUE(database.ok());
    std::vector<Node> path;
    expectContainment(database.value(), database.value().root().value(), path);
  }
}

TEST(NodeBounds, a_leaf_without_any_post_is_empty_and_its_parents_are_not) {
  SyntheticGridOptions options;
  options.voids = VoidPattern::kWestHalf;
  const MemoryFileSystem files = buildInMemory(syntheticGrid(options), {.leaf_cells = 8});
  Result<Database> database = Database::open(files, kMemoryDatabasePath);
  ASSERT_TRUE(database.ok());
  const Result<std::vector<Node>> leaves = nodesOfLevel(database.value(), 0, 0);
  ASSERT_TRUE(leaves.ok());
  std::size_t empty = 0;
  for (const Node& leaf : leaves.value()) {
    if (!leaf.record.isEmpty()) continue;
    ++empty;
    EXPECT_EQ(leaf.record.valid_posts, 0u);
    EXPECT_EQ(leaf.record.radius, 0u);
  }
  EXPECT_GT(empty, leaves.value().size() / 3);
  EXPECT_FALSE(database.value().root().value().record.isEmpty());
}

}  // namespace
}  // namespace deltaz
