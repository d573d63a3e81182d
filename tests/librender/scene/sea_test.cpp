#include "librender/scene/sea.h"

#include <cmath>
#include <gtest/gtest.h>
#include <rapidcheck.h>

namespace deltaz {
namespace {

const EllipsoidShape kWgs84;

struct Scene {
  AreaHeader area;
  ViewTransform view;
  Sea sea;
};

Scene sceneAt(double height, double pitch, double lowest = 0) {
  AreaHeader area;
  area.lowest_height = lowest;
  area.grids.emplace_back();
  Camera camera;
  camera.eye = {40, 20, height};
  camera.pitch = pitch;
  const ViewTransform view = makeViewTransform(camera, kWgs84);
  const Light light = makeLight(area, Sun{});
  return {area, view, Sea(area, view, light, Atmosphere(kWgs84, view, light.to_sun))};
}

TEST(Sea, lies_at_the_lowest_height) {
  for (const double lowest : {-400.0, 0.0, 3000.0}) {
    const Scene scene = sceneAt(lowest + 500, -30, lowest);
    for (int j = 0; j < 1280; j += 64) {
      for (int i = 0; i < 720; i += 36) {
        const Vector3 ray = scene.view.ray(j, i);
        const double u = scene.sea.depth(ray);
        if (!std::isfinite(u)) continue;
        // A few centimetres: the ellipsoid of grown axes is not quite the parallel surface.
        EXPECT_NEAR(toGeodetic(kWgs84, scene.view.eye + ray * u).height, lowest, 0.05);
      }
    }
  }
}

TEST(Sea, ends_at_the_horizon) {
  const double height = 2000;
  const Scene scene = sceneAt(height, 0);
  // Dip of the horizon on the meridian's radius of curvature, about 6,361 km at 40 degrees north.
  const double dip = std::acos(6361000.0 / (6361000.0 + height));
  const double row = scene.view.centre_i + std::tan(dip) * scene.view.pixels;
  EXPECT_TRUE(std::isinf(scene.sea.depth(scene.view.ray(scene.view.centre_j, row - 0.05))));
  EXPECT_TRUE(std::isfinite(scene.sea.depth(scene.view.ray(scene.view.centre_j, row + 0.05))));
}

TEST(Sea, is_not_drawn_for_an_eye_within_it) {
  const Scene scene = sceneAt(-1, -30);
  EXPECT_TRUE(std::isinf(scene.sea.depth(scene.view.ray(640, 700))));
}

TEST(Sea, hides_what_is_behind_the_horizon) {
  const Scene scene = sceneAt(10, 0);
  // A point 50 m high, 60 km away: the horizon of both together is at about 37 km.
  const double far_latitude = 40 + 60000 / 111035.0;
  const Vector3 low = toEarthCentred(kWgs84, {far_latitude, 20, 50});
  const Vector3 high = toEarthCentred(kWgs84, {far_latitude, 20, 500});
  for (const auto& [point, hidden] : {std::pair{low, true}, std::pair{high, false}}) {
    const Vector3 p = scene.view.toView(point);
    const Vector3 ray = scene.view.ray(scene.view.centre_j + p.y / p.x, scene.view.centre_i + p.z / p.x);
    EXPECT_EQ(scene.sea.depth(ray) < p.x, hidden);
  }
}

}  // namespace
}  // namespace deltaz
