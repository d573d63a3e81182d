#include "librender/scene/screen_extent.h"

#include <cmath>
#include <gtest/gtest.h>
#include <random>

#include "librender/scene/view_volume.h"
#include "tests/librender/cut_checks.h"
#include "tests/librender/scene/node_samples.h"

namespace deltaz {
namespace {

TEST(ScreenExtent, holds_every_pixel_that_a_post_falls_into_and_its_depth) {
  std::mt19937 random(31);
  std::uint64_t seen = 0, small = 0, empty = 0;
  for (const SyntheticGridOptions& options : areasOfAllSorts()) {
    const MemoryDatabase area = makeDatabase(options, 8);
    std::vector<ViewTransform> views;
    for (int n = 0; n < 15; ++n)
      views.push_back(makeViewTransform(randomView(area.database, random, 320, 200), EllipsoidShape{}));
    forEachNode(area.database, [&](const Node& node, const std::vector<SamplePost>& posts) {
      const NodeVolume volume = volumeOf(node, area.database.grid(0), true);
      for (const ViewTransform& view : views) {
        const ScreenExtent extent = screenExtent(view, volume);
        empty += extent.empty() ? 1 : 0;
        if (!extent.empty() && extent.last_j - extent.first_j < 160) ++small;
        for (std::size_t k = random() % 7; k < posts.size(); k += 7) {
          const Vector3 p = view.toView(posts[k].position);
          if (!(p.x > kHither)) continue;
          const double j = std::round(view.centre_j + p.y / p.x), i = std::round(view.centre_i + p.z / p.x);
          if (j < 0 || i < 0 || j >= view.width || i >= view.height) continue;
          ++seen;
          ASSERT_LE(extent.first_j, j);
          ASSERT_GE(extent.last_j, j);
          ASSERT_LE(extent.first_i, i);
          ASSERT_GE(extent.last_i, i);
          ASSERT_LE(1 / p.x, extent.largest_inverse_u);
        }
      }
    });
  }
  EXPECT_GT(seen, 10000u);
  EXPECT_GT(small, 1000u);
  EXPECT_GT(empty, 1000u);
}

TEST(ScreenExtent, is_hardly_larger_than_a_far_node) {
  const MemoryDatabase area = makeDatabase(smallArea(), 16);
  const NodeVolume volume =
      volumeOf(nodesOfLevel(area.database, 0, 0).value().front(), area.database.grid(0), true);
  Camera camera;
  camera.eye = toGeodetic(EllipsoidShape{}, volume.centre);
  camera.eye.height += 20000;
  camera.pitch = -90;
  const ViewTransform view = makeViewTransform(camera, EllipsoidShape{});
  const ScreenExtent extent = screenExtent(view, volume);
  const double across = 2 * volume.horizontal / 20000 * view.pixels;
  EXPECT_FALSE(extent.empty());
  EXPECT_LT(extent.last_j - extent.first_j, across * 1.5);
  EXPECT_LT(extent.last_i - extent.first_i, across * 1.5);
  // A margin moves its borders outwards.
  const ScreenExtent wider = screenExtent(view, volume, 3);
  EXPECT_EQ(wider.first_j, extent.first_j - 3);
  EXPECT_EQ(wider.last_i, extent.last_i + 3);
}

}  // namespace
}  // namespace deltaz
