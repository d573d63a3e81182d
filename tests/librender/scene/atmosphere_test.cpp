#include "librender/scene/atmosphere.h"

#include <cmath>
#include <gtest/gtest.h>

#include "librender/scene/exponential.h"

namespace deltaz {
namespace {

const EllipsoidShape kWgs84;

struct Air {
  ViewTransform view;
  Atmosphere atmosphere;
};

Air airAt(double height, double pitch) {
  Camera camera;
  camera.eye = {45, 10, height};
  camera.pitch = pitch;
  const ViewTransform view = makeViewTransform(camera, kWgs84);
  const Vector3 up = upVector(rowConstants(kWgs84, 45), columnConstants(10));
  return {view, Atmosphere(kWgs84, view, up)};
}

double shareKept(const Air& air, const Vector3& ray, double u) {
  const LinearColor black = air.atmosphere.throughHaze({0, 0, 0}, ray, u);
  return 1 - black.green / air.atmosphere.hazeColor().green;
}

TEST(Exponential, is_that_of_the_library) {
  for (double x = -690; x < 690; x += 0.37) EXPECT_NEAR(exponential(x) / std::exp(x), 1, 1e-13) << x;
  EXPECT_EQ(exponential(0), 1);
  EXPECT_EQ(exponential(-1e9), 0);
}

TEST(Atmosphere, keeps_near_ground_and_fades_far_ground_at_eye_level) {
  const Air air = airAt(300, 0);
  const Vector3 ray = air.view.ray(air.view.centre_j, air.view.centre_i);
  EXPECT_GT(shareKept(air, ray, 500), 0.97);
  const double far = shareKept(air, ray, 50000);
  EXPECT_GT(far, 0.1);
  EXPECT_LT(far, 0.5);
}

TEST(Atmosphere, an_overview_from_high_up_stays_clear) {
  const Air air = airAt(150000, -45);
  const Vector3 ray = air.view.ray(air.view.centre_j, air.view.centre_i);
  EXPECT_GT(shareKept(air, ray, 205000), 0.75);
}

TEST(Atmosphere, haze_grows_with_distance) {
  const Air air = airAt(2000, -1);
  const Vector3 ray = air.view.ray(air.view.centre_j, air.view.centre_i);
  double before = 1;
  for (double u = 100; u < 100000; u *= 1.3) {
    const double now = shareKept(air, ray, u);
    EXPECT_LT(now, before);
    before = now;
  }
}

// The integral along the path, summed directly on a flat Earth.
TEST(Atmosphere, optical_depth_is_that_of_exponential_layers) {
  const double height = 3000, pitch = -20, distance = 7000;
  const Air air = airAt(height, pitch);
  double molecular = 0, aerosol = 0;
  constexpr int kSteps = 20000;
  for (int step = 0; step < kSteps; ++step) {
    const double along = distance * (step + 0.5) / kSteps;
    const double h = height + along * std::sin(pitch * std::acos(-1) / 180);
    molecular += 0.5e-5 * std::exp(-h / 8000) * distance / kSteps;
    aerosol += 2.0e-5 * std::exp(-h / 2000) * distance / kSteps;
  }
  const Vector3 ray = air.view.ray(air.view.centre_j, air.view.centre_i);
  EXPECT_NEAR(shareKept(air, ray, distance), std::exp(-molecular - aerosol), 2e-4);
}

TEST(Atmosphere, nearly_level_paths_join_the_others_without_a_step) {
  const Air air = airAt(1000, 0);
  double before = -1;
  for (int step = -400; step <= 400; ++step) {
    const Vector3 ray = air.view.ray(air.view.centre_j, air.view.centre_i + step * 0.05);
    const double now = shareKept(air, ray, 3000);
    if (before >= 0) {
      EXPECT_NEAR(now, before, 1e-5);
    }
    before = now;
  }
}

// Facets of a globe at its coarsest sag by kilometres; the air over them must not thicken.
TEST(Atmosphere, ground_far_below_the_ellipsoid_is_seen_through_little_more_air) {
  const Air air = airAt(400000, -90);
  const Vector3 ray = air.view.ray(air.view.centre_j, air.view.centre_i);
  const double at_surface = shareKept(air, ray, 400000), below = shareKept(air, ray, 410000);
  EXPECT_GT(at_surface, 0.5);
  EXPECT_LT(below, at_surface);
  EXPECT_GT(below, 0.97 * at_surface);
}

TEST(Atmosphere, sky_meets_the_haze_at_the_horizon_and_darkens_upwards) {
  const Air air = airAt(500, 30);
  const LinearColor haze = air.atmosphere.hazeColor();
  double before = 2;
  for (int i = 719; i >= 0; --i) {
    const LinearColor sky = air.atmosphere.sky(air.view.ray(640, i));
    EXPECT_LE(sky.red, before);
    EXPECT_LE(sky.red, haze.red + 1e-12);
    before = sky.red;
  }
  const Air level = airAt(500, 0);
  const double dip = std::acos(6378137.0 / (6378137.0 + 500));
  const double row = level.view.centre_i + std::tan(dip) * level.view.pixels;
  EXPECT_NEAR(level.atmosphere.sky(level.view.ray(640, row)).red, level.atmosphere.hazeColor().red, 1e-3);
}

}  // namespace
}  // namespace deltaz
