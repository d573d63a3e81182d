// Nodes of areas of all sorts, and the points they draw, for tests of what is said of whole nodes.
#pragma once

#include <functional>
#include <vector>

#include "tests/librender/test_databases.h"

namespace deltaz {

// Rough country at middle latitudes, below the sea, over the antimeridian, at a pole, with voids, and coarse
// posts over ten degrees.
inline std::vector<SyntheticGridOptions> areasOfAllSorts() {
  std::vector<SyntheticGridOptions> areas(6, smallArea());
  areas[1].south = -34;
  areas[1].lowest = -4000;
  areas[1].highest = -300;
  areas[2].west = 179.95;
  areas[2].voids = VoidPattern::kScattered;
  areas[3].south = 89.5;
  areas[3].spacing_latitude = {15, 1};
  areas[3].spacing_longitude = {600, 1};
  areas[4].voids = VoidPattern::kHole;
  areas[5].south = 40;
  areas[5].west = -120;
  areas[5].spacing_latitude = areas[5].spacing_longitude = {300, 1};
  areas[5].lowest = -40;
  areas[5].highest = 6000;
  return areas;
}

// A post of a node, its own or one below it.
struct SamplePost {
  Vector3 position, up;
};

// Calls `use` for each node of the area that draws something, with all its valid posts down to level 0.
inline void forEachNode(const Database& database,
                        const std::function<void(const Node&, const std::vector<SamplePost>&)>& use) {
  const GridGeometry& geometry = database.grid(0);
  const std::function<std::vector<SamplePost>(const Node&)> visit = [&](const Node& node) {
    std::vector<SamplePost> posts;
    if (node.record.isEmpty()) return posts;
    if (node.record.level == 0) {
      const TerrainTile tile = database.terrain(node).value();
      for (int j = 0; j < tile.rows; ++j) {
        for (int i = 0; i < tile.columns; ++i) {
          if (!tile.isValid(i, j)) continue;
          const PostPlace place = geometry.placeAt(tile.first_column + i, tile.first_row + j);
          posts.push_back({place.at(geometry.metres(tile.height(i, j))), place.up});
        }
      }
    }
    for (const Node& child : database.children(node).value()) {
      const std::vector<SamplePost> below = visit(child);
      posts.insert(posts.end(), below.begin(), below.end());
    }
    use(node, posts);
    return posts;
  };
  for (const Node& node : nodesOfLevel(database, 0, geometry.header().level_count - 1).value()) visit(node);
}

}  // namespace deltaz
