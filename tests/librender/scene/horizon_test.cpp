#include "librender/scene/horizon.h"

#include <cmath>
#include <gtest/gtest.h>
#include <random>

#include "librender/scene/sea.h"
#include "tests/librender/scene/node_samples.h"

namespace deltaz {
namespace {

double uniform(std::mt19937& random, double low, double high) {
  return std::uniform_real_distribution<double>(low, high)(random);
}

Sea seaOf(const AreaHeader& area, const ViewTransform& view) {
  const EllipsoidShape ellipsoid = area.grids.front().ellipsoid;
  return {area, view, Light{}, Atmosphere(ellipsoid, view, {0, 0, 1})};
}

// An eye 1.7 m to 200 km above the sea, within some degrees of the area.
ViewTransform randomEye(const AreaHeader& area, std::mt19937& random) {
  Camera camera;
  camera.eye = {std::clamp(area.south + uniform(random, -8, 8), -90.0, 90.0),
                area.west + uniform(random, -8, 8),
                area.lowest_height + std::pow(10.0, uniform(random, 0.23, 5.3))};
  return makeViewTransform(camera, area.grids.front().ellipsoid);
}

// True if the sea is met before the point.
bool behindSea(const Sea& sea, const ViewTransform& view, const Vector3& point) {
  return sea.depth(point - view.eye) < 1;
}

TEST(Horizon, hides_no_point_of_a_node_that_is_not_behind_the_sea) {
  std::mt19937 random(5);
  std::uint64_t hidden = 0, shown = 0;
  for (const SyntheticGridOptions& options : areasOfAllSorts()) {
    const MemoryDatabase memory = makeDatabase(options, 16);
    const AreaHeader& area = memory.database.area();
    std::vector<ViewTransform> views;
    for (int n = 0; n < 30; ++n) views.push_back(randomEye(area, random));
    forEachNode(memory.database, [&](const Node& node, const std::vector<SamplePost>& posts) {
      const NodeVolume volume = volumeOf(node, memory.database.grid(0), true);
      for (const ViewTransform& view : views) {
        if (!Horizon(area, view.eye).hides(volume)) {
          ++shown;
          continue;
        }
        ++hidden;
        const Sea sea = seaOf(area, view);
        for (const SamplePost& post : posts) ASSERT_TRUE(behindSea(sea, view, post.position));
        // Points between posts, and all the volume holds.
        for (int n = 0; n < 20; ++n) {
          const Vector3 &a = posts[random() % posts.size()].position,
                        &b = posts[random() % posts.size()].position;
          ASSERT_TRUE(behindSea(sea, view, a + (b - a) * uniform(random, 0, 1)));
          const double y = uniform(random, volume.low, volume.high);
          const Vector3 aside = normalized(cross(volume.up, a - view.eye));
          const double across = std::sqrt(volume.radius * volume.radius - y * y);
          ASSERT_TRUE(
              behindSea(sea, view, volume.centre + volume.up * y + aside * uniform(random, -across, across)));
        }
      }
    });
  }
  EXPECT_GT(hidden, 1000u);
  EXPECT_GT(shown, 1000u);
}

TEST(Horizon, lies_where_the_tangent_meets_the_sea) {
  const MemoryDatabase memory = makeDatabase(smallArea(), 16);
  const AreaHeader& area = memory.database.area();
  const EllipsoidShape ellipsoid;
  const double sea_level = area.lowest_height - area.sea_drop;
  for (const double above : {1.7, 100.0, 10000.0, 200000.0}) {
    const Vector3 eye = toEarthCentred(ellipsoid, {45, -100, sea_level + above});
    const Horizon horizon(area, eye);
    // Northwards at the height of the eye: hidden from twice the distance of the horizon on.
    const double degrees = std::acos(6.36e6 / (6.36e6 + above)) * 180 / 3.14159265358979;
    EXPECT_FALSE(horizon.hides(toEarthCentred(ellipsoid, {45 + 1.97 * degrees, -100, sea_level + above})));
    EXPECT_TRUE(horizon.hides(toEarthCentred(ellipsoid, {45 + 2.03 * degrees, -100, sea_level + above})));
    // On the sea's own level from the horizon on.
    EXPECT_FALSE(horizon.hides(toEarthCentred(ellipsoid, {45 + 0.9 * degrees, -100, sea_level})));
    EXPECT_TRUE(horizon.hides(toEarthCentred(ellipsoid, {45 + 1.1 * degrees, -100, sea_level})));
  }
}

TEST(Horizon, hides_nothing_from_an_eye_in_the_sea) {
  const MemoryDatabase memory = makeDatabase(smallArea(), 16);
  const AreaHeader& area = memory.database.area();
  const double sea_level = area.lowest_height - area.sea_drop;
  for (const double above : {-1000.0, -0.1}) {
    const Horizon horizon(area, toEarthCentred(EllipsoidShape{}, {45, -100, sea_level + above}));
    for (const double latitude : {45.1, 50.0, -45.0})
      EXPECT_FALSE(horizon.hides(toEarthCentred(EllipsoidShape{}, {latitude, -100, sea_level + 10})));
  }
}

}  // namespace
}  // namespace deltaz
