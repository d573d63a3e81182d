#include "librender/scene/view_volume.h"

#include <cmath>
#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <utility>

namespace deltaz {
namespace {

ViewTransform someView() {
  Camera camera;
  camera.eye = {47, -121, 3000};
  camera.heading = 30;
  camera.pitch = -20;
  camera.roll = 10;
  camera.width = 640;
  camera.height = 360;
  return makeViewTransform(camera, EllipsoidShape{});
}

TEST(ViewVolume, never_rejects_a_sphere_that_holds_a_visible_point) {
  const ViewTransform view = someView();
  const ViewVolume volume(view);
  EXPECT_TRUE(rc::check([&] {
    const double u = *rc::gen::inRange(1, 100000), radius = *rc::gen::inRange(1, 5000);
    const Vector3 visible = view.eye + view.ray(*rc::gen::inRange(0, 640), *rc::gen::inRange(0, 360)) * u;
    const Vector3 direction{*rc::gen::inRange(-100, 101) / 100.0, *rc::gen::inRange(-100, 101) / 100.0, 1.01};
    const Vector3 centre = visible + normalized(direction) * (radius * 0.999999);
    RC_ASSERT(!volume.isOutside(centre, radius));
  }));
}

TEST(ViewVolume, rejects_what_is_behind_or_beside) {
  const ViewTransform view = someView();
  const ViewVolume volume(view);
  EXPECT_TRUE(volume.isOutside(view.eye - view.forward * 1000, 900));
  EXPECT_TRUE(volume.isOutside(view.eye + view.ray(-400, 180) * 1000, 100));
  EXPECT_TRUE(volume.isOutside(view.eye + view.ray(1040, 180) * 1000, 100));
  EXPECT_TRUE(volume.isOutside(view.eye + view.ray(320, -300) * 1000, 100));
  EXPECT_TRUE(volume.isOutside(view.eye + view.ray(320, 660) * 1000, 100));
  EXPECT_FALSE(volume.isOutside(view.eye + view.ray(320, 180) * 1000, 0));
}

TEST(ViewVolume, a_margin_is_so_many_pixels_on_each_side) {
  const ViewTransform view = someView();
  const ViewVolume volume(view), wider(view, 8);
  for (const auto& [j, i] : {std::pair{-5.0, 180.0}, {644.0, 180.0}, {320.0, -5.0}, {320.0, 364.0}}) {
    EXPECT_TRUE(volume.isOutside(view.eye + view.ray(j, i) * 1000, 0));
    EXPECT_FALSE(wider.isOutside(view.eye + view.ray(j, i) * 1000, 0));
  }
  EXPECT_TRUE(wider.isOutside(view.eye + view.ray(-9, 180) * 1000, 0));
  EXPECT_TRUE(wider.isOutside(view.eye + view.ray(320, 369) * 1000, 0));
}

}  // namespace
}  // namespace deltaz
