#include "librender/scene/ray_lists.h"

#include <array>
#include <cmath>
#include <gtest/gtest.h>
#include <limits>
#include <random>
#include <vector>

#include "libdb/access/simd_target.h"
#include "librender/scene/sea.h"

namespace deltaz {
namespace {

constexpr std::size_t kRays = 203;

using List = std::array<double, kRays + kVectorPadding>;

struct Lists {
  List x{}, y{}, z{}, u{}, red{}, green{}, blue{};
  RayLists rays() const { return {x.data(), y.data(), z.data(), kRays}; }
  ColorLists colors() { return {red.data(), green.data(), blue.data()}; }
  Vector3 ray(std::size_t n) const { return {x[n], y[n], z[n]}; }
  LinearColor color(std::size_t n) const { return {red[n], green[n], blue[n]}; }
};

void expectSame(const LinearColor& a, const LinearColor& b) {
  EXPECT_EQ(a.red, b.red);
  EXPECT_EQ(a.green, b.green);
  EXPECT_EQ(a.blue, b.blue);
}

// Whatever the lists say, the functions of one ray say, to the last bit.
TEST(RayLists, give_sea_sky_and_haze_of_each_ray_on_every_vector_width) {
  AreaHeader area;
  area.grids.resize(1);
  area.lowest_height = 12;
  area.sea_drop = 3;
  int met = 0, missed = 0;
  for (const double height : {-400.0, 30.0, 3000.0, 400000.0}) {
    Camera camera;
    camera.eye = {46.5, 7.5, height};
    camera.pitch = -10;
    camera.field_of_view = 110;
    const EllipsoidShape& ellipsoid = area.grids.front().ellipsoid;
    const ViewTransform view = makeViewTransform(camera, ellipsoid);
    Light light;
    light.to_sun = view.forward * -1;
    const Atmosphere atmosphere(ellipsoid, view, light.to_sun);
    const Sea sea(area, view, light, atmosphere);
    std::mt19937 random(3);
    std::uniform_real_distribution<double> place(-200, 1400), distance(0.1, 13);
    Lists lists;
    for (std::size_t n = 0; n < kRays; ++n) {
      const Vector3 ray = view.ray(place(random), place(random) / 2);
      lists.x[n] = ray.x;
      lists.y[n] = ray.y;
      lists.z[n] = ray.z;
    }
    List depths{};
    for (double& depth : depths) depth = std::exp(distance(random));
    depths[5] = 1e-3;
    for (const SimdTarget target : simdTargets()) {
      SCOPED_TRACE(simdTargetName(target));
      ASSERT_TRUE(limitSimdTarget(target));
      sea.depths(lists.rays(), lists.u.data());
      sea.colors(lists.rays(), lists.u.data(), lists.colors());
      for (std::size_t n = 0; n < kRays; ++n) {
        ASSERT_EQ(lists.u[n], sea.depth(lists.ray(n)));
        const bool is_met = std::isfinite(lists.u[n]);
        (is_met ? met : missed) += 1;
        if (is_met) expectSame(lists.color(n), sea.color(lists.ray(n), lists.u[n]));
      }
      atmosphere.skies(lists.rays(), lists.colors());
      for (std::size_t n = 0; n < kRays; ++n) expectSame(lists.color(n), atmosphere.sky(lists.ray(n)));
      for (std::size_t n = 0; n < kRays; ++n) lists.red[n] = lists.green[n] = lists.blue[n] = 0.25;
      atmosphere.throughHaze(lists.rays(), depths.data(), lists.colors());
      for (std::size_t n = 0; n < kRays; ++n)
        expectSame(lists.color(n), atmosphere.throughHaze({0.25, 0.25, 0.25}, lists.ray(n), depths[n]));
    }
  }
  limitSimdTarget(std::nullopt);
  EXPECT_GT(met, 500);
  EXPECT_GT(missed, 500);
}

}  // namespace
}  // namespace deltaz
