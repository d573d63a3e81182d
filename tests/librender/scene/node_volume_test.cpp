#include "librender/scene/node_volume.h"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <random>

#include "tests/librender/scene/node_samples.h"

namespace deltaz {
namespace {

Vector3 randomDirection(std::mt19937& random) {
  std::normal_distribution<double> normal;
  return normalized({normal(random), normal(random), normal(random)});
}

TEST(NodeVolume, holds_every_post_below_and_how_far_their_normals_lean) {
  for (const SyntheticGridOptions& options : areasOfAllSorts()) {
    const MemoryDatabase area = makeDatabase(options, 8);
    int nodes = 0;
    forEachNode(area.database, [&](const Node& node, const std::vector<SamplePost>& posts) {
      const NodeVolume volume = volumeOf(node, area.database.grid(0), true);
      ++nodes;
      for (const SamplePost& post : posts) {
        const Vector3 offset = post.position - volume.centre;
        const double along = dot(volume.up, offset);
        ASSERT_GE(along, volume.low) << "level " << int(node.record.level);
        ASSERT_LE(along, volume.high) << "level " << int(node.record.level);
        ASSERT_LE(length(offset), volume.radius + 1e-6);
        ASSERT_LE(length(offset - volume.up * along), volume.horizontal + 1e-6);
        ASSERT_LE(length(post.up - volume.up), volume.normal_spread);
      }
    });
    EXPECT_GT(nodes, 20);
  }
}

TEST(NodeVolume, is_as_flat_as_the_ground) {
  const MemoryDatabase area = makeDatabase(smallArea(), 16);
  const GridGeometry& geometry = area.database.grid(0);
  forEachNode(area.database, [&](const Node& node, const std::vector<SamplePost>& posts) {
    if (posts.size() < 4) return;
    const NodeVolume volume = volumeOf(node, geometry, true);
    const double heights =
        geometry.metres(node.record.maximum_height) - geometry.metres(node.record.minimum_height);
    const double falls = 4 * volume.radius * volume.radius / 6.3e6;
    EXPECT_LE(volume.high - volume.low, std::min(2 * volume.radius, heights + falls + 0.1));
    EXPECT_LT(volume.normal_spread, 2.1 * volume.radius / 6.3e6);
  });
}

TEST(NodeVolume, reaches_as_far_as_its_points_and_is_no_nearer_than_its_nearest) {
  std::mt19937 random(3);
  for (const SyntheticGridOptions& options : areasOfAllSorts()) {
    const MemoryDatabase area = makeDatabase(options, 16);
    forEachNode(area.database, [&](const Node& node, const std::vector<SamplePost>& posts) {
      const NodeVolume volume = volumeOf(node, area.database.grid(0), true);
      for (int n = 0; n < 6; ++n) {
        const Vector3 direction = randomDirection(random);
        const double reach = reachAlong(volume, direction);
        const Vector3 eye =
            volume.centre + randomDirection(random) * (volume.radius * std::ldexp(1.0, n - 2));
        const double least = leastDistance(volume, eye);
        const std::array<Vector3, 8> box = boxAround(volume, eye);
        for (const SamplePost& post : posts) {
          ASSERT_LE(dot(direction, post.position - volume.centre), reach + 1e-6);
          ASSERT_GE(length(post.position - eye), least - 1e-6);
        }
        // A box reaches as far as its corners.
        double of_box = -HUGE_VAL;
        for (const Vector3& corner : box) of_box = std::max(of_box, dot(direction, corner - volume.centre));
        ASSERT_GE(of_box, reach - 1e-6);
      }
    });
  }
}

TEST(NodeVolume, is_the_ball_alone_where_seams_do_more_than_the_heights_say) {
  const MemoryDatabase area = makeDatabase(smallArea(), 16);
  const Node node = nodesOfLevel(area.database, 0, 0).value().front();
  const NodeVolume volume = volumeOf(node, area.database.grid(0), false);
  EXPECT_EQ(volume.low, -node.radius());
  EXPECT_EQ(volume.high, node.radius());
  EXPECT_EQ(volume.horizontal, node.radius());
}

}  // namespace
}  // namespace deltaz
