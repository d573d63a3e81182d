#include "librender/scene/sea_cover.h"

#include <cmath>
#include <gtest/gtest.h>
#include <limits>
#include <random>

namespace deltaz {
namespace {

struct Scene {
  ViewTransform view;
  Sea sea;
};

Scene sceneFrom(double height, double pitch, double roll, double field_of_view) {
  AreaHeader area;
  area.grids.emplace_back();
  area.grids.front().ellipsoid = {6378137, 298.257223563};
  Camera camera;
  camera.eye = {46, -121, height};
  camera.heading = 30;
  camera.pitch = pitch;
  camera.roll = roll;
  camera.field_of_view = field_of_view;
  camera.width = 320;
  camera.height = 200;
  const ViewTransform view = makeViewTransform(camera, area.grids.front().ellipsoid);
  const Light light = makeLight(area, Sun{});
  const Atmosphere atmosphere(area.grids.front().ellipsoid, view, light.to_sun);
  return {view, Sea(area, view, light, atmosphere)};
}

template <typename Check>
void forScenes(Check&& check) {
  for (const double height : {2.0, 500.0, 30e3, 2e6, 40e6, 3e9}) {
    for (const double pitch : {-90.0, -30.0, -2.0, 0.0, 10.0, 70.0}) check(sceneFrom(height, pitch, 25, 60));
  }
}

TEST(SeaCover, is_right_about_nowhere_and_everywhere) {
  int nowhere = 0, everywhere = 0, partly = 0;
  std::mt19937 random(3);
  std::uniform_real_distribution<double> place(-40, 330), size(1, 64);
  forScenes([&](const Scene& scene) {
    for (int n = 0; n < 60; ++n) {
      const double j = place(random), i = place(random) * 0.6, width = size(random), height = size(random);
      const SeaCover cover = seaCover(scene.sea.terms(), scene.view, j, i, j + width, i + height);
      std::size_t met = 0, all = 0;
      for (double y = 0; y <= 1; y += 1.0 / 16) {
        for (double x = 0; x <= 1; x += 1.0 / 16, ++all) {
          met += scene.sea.depth(scene.view.ray(j + x * width, i + y * height)) <
                         std::numeric_limits<double>::infinity()
                     ? 1
                     : 0;
        }
      }
      if (cover == SeaCover::kNowhere) {
        EXPECT_EQ(met, 0U);
      }
      if (cover == SeaCover::kEverywhere) {
        EXPECT_EQ(met, all);
      }
      if (met == all) {
        EXPECT_EQ(cover, SeaCover::kEverywhere);
      }
      ++(cover == SeaCover::kNowhere ? nowhere : cover == SeaCover::kPartly ? partly : everywhere);
    }
  });
  EXPECT_GT(nowhere, 100);
  EXPECT_GT(everywhere, 100);
  EXPECT_GT(partly, 50);
}

// Rays that lead up would meet the sea behind the eye.
TEST(SeaCover, of_the_sky_is_nowhere) {
  for (const double height : {2.0, 500.0, 30e3}) {
    const Scene scene = sceneFrom(height, 40, 0, 60);
    EXPECT_EQ(seaCover(scene.sea.terms(), scene.view, 0, 0, 319, 199), SeaCover::kNowhere);
  }
}

TEST(SeaCover, of_an_eye_in_the_sea_is_nowhere) {
  const Scene scene = sceneFrom(-100, -30, 0, 60);
  EXPECT_EQ(seaCover(scene.sea.terms(), scene.view, 0, 0, 320, 200), SeaCover::kNowhere);
}

TEST(SeaBound, touches_the_sea_and_lies_nowhere_below_it) {
  int checked = 0;
  forScenes([&](const Scene& scene) {
    for (int i = 10; i < 200; i += 60) {
      for (int j = 10; j < 320; j += 100) {
        const double u = scene.sea.depth(scene.view.ray(j, i));
        if (!(u < std::numeric_limits<double>::infinity())) continue;
        const SeaBound bound = seaBound(scene.sea.terms(), scene.view, j, i);
        EXPECT_NEAR(bound.at(j, i) * u, 1, 1e-9);
        for (int di = -32; di <= 32; di += 8) {
          for (int dj = -32; dj <= 32; dj += 8) {
            const double there = scene.sea.depth(scene.view.ray(j + dj, i + di));
            if (!(there < std::numeric_limits<double>::infinity())) continue;
            EXPECT_LE(1 / there, bound.at(j + dj, i + di) + 1e-9 / u);
            ++checked;
          }
        }
      }
    }
  });
  EXPECT_GT(checked, 5000);
}

}  // namespace
}  // namespace deltaz
