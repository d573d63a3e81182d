#include "librender/scene/normal_cone.h"

#include <gtest/gtest.h>
#include <random>

#include "librender/objects/terrain_object_processor.h"
#include "tests/librender/scene/node_samples.h"

namespace deltaz {
namespace {

// All nodes below a node, itself included.
void addBelow(const Database& database, const Node& node, std::vector<Node>& nodes) {
  if (node.record.isEmpty()) return;
  nodes.push_back(node);
  for (const Node& child : database.children(node).value()) addBelow(database, child, nodes);
}

TEST(NormalCone, no_face_of_a_node_turned_away_shows_its_front_at_any_level) {
  std::mt19937 random(8);
  const auto uniform = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  std::uint64_t away = 0, not_away = 0, faces = 0;
  for (SyntheticGridOptions options : areasOfAllSorts()) {
    // Gentle and rough country.
    for (const double relief : {1.0, 0.05}) {
      SyntheticGridOptions country = options;
      country.highest =
          options.lowest + static_cast<std::int32_t>((options.highest - options.lowest) * relief);
      const MemoryDatabase area = makeDatabase(country, 8);
      const AreaHeader& header = area.database.area();
      std::vector<Node> nodes;
      for (const Node& node :
           nodesOfLevel(area.database, 0, area.database.grid(0).header().level_count - 1).value())
        addBelow(area.database, node, nodes);
      for (int n = 0; n < 300; ++n) {
        // Beside slopes, low over the ground, and under it.
        const Node& node = nodes[random() % nodes.size()];
        const Vector3 up = normalized(node.centroid);
        const Vector3 aside = normalized(cross(up, {uniform(-1, 1), uniform(-1, 1), uniform(-1, 1)}));
        const double distance = node.radius() * uniform(1, 20);
        const ViewTransform view = [&] {
          ViewTransform result = makeViewTransform(Camera{}, header.grids.front().ellipsoid);
          result.eye = node.centroid + aside * distance - up * (distance * uniform(-0.3, 1));
          return result;
        }();
        if (!facesAway(node, view.eye)) {
          ++not_away;
          continue;
        }
        ++away;
        std::vector<Node> below;
        addBelow(area.database, node, below);
        for (const Node& one : below) {
          const TerrainTile tile = area.database.terrain(one).value();
          const TerrainFaces drawn = terrainFaces(tile, terrainPositions(tile, area.database.grid(0), view));
          ASSERT_TRUE(drawn.front.empty()) << "level " << int(one.record.level);
          faces += drawn.in;
        }
      }
    }
  }
  EXPECT_GT(away, 300u);
  EXPECT_GT(not_away, 300u);
  EXPECT_GT(faces, 10000u);
}

}  // namespace
}  // namespace deltaz
