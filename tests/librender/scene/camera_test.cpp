#include "librender/scene/camera.h"

#include <GeographicLib/LocalCartesian.hpp>
#include <cmath>
#include <gtest/gtest.h>
#include <numbers>
#include <rapidcheck.h>

namespace deltaz {
namespace {

constexpr double kRadian = std::numbers::pi / 180;
const EllipsoidShape kWgs84;

AreaHeader areaOf(double west, double south, double east, double north, double low, double high) {
  AreaHeader area;
  area.west = west;
  area.south = south;
  area.east = east;
  area.north = north;
  area.lowest_height = low;
  area.highest_height = high;
  area.grids.emplace_back();
  return area;
}

TEST(Camera, axes_are_orthonormal_and_right_handed_anywhere) {
  EXPECT_TRUE(rc::check([] {
    Camera camera;
    camera.eye = {*rc::gen::inRange(-900, 901) / 10.0, *rc::gen::inRange(-3600, 3601) / 10.0,
                  *rc::gen::inRange(-400, 100000) * 1.0};
    camera.heading = *rc::gen::inRange(-360, 361);
    camera.pitch = *rc::gen::inRange(-90, 91);
    camera.roll = *rc::gen::inRange(-180, 181);
    const ViewTransform view = makeViewTransform(camera, kWgs84);
    RC_ASSERT(std::abs(length(view.forward) - 1) < 1e-14);
    RC_ASSERT(std::abs(length(view.right) - 1) < 1e-14);
    RC_ASSERT(std::abs(dot(view.forward, view.right)) < 1e-14);
    RC_ASSERT(length(cross(view.forward, view.right) - view.down) < 1e-14);
  }));
}

// GeographicLib's local east, north, up coordinates are an independent way to the same view.
TEST(Camera, heading_pitch_and_roll_mean_what_they_say) {
  EXPECT_TRUE(rc::check([] {
    Camera camera;
    camera.eye = {*rc::gen::inRange(-890, 891) / 10.0, *rc::gen::inRange(-1800, 1801) / 10.0, 1234};
    camera.heading = *rc::gen::inRange(0, 360);
    camera.pitch = *rc::gen::inRange(-80, 81);
    camera.width = 640;
    camera.height = 480;
    camera.field_of_view = 90;
    const ViewTransform view = makeViewTransform(camera, kWgs84);
    const GeographicLib::LocalCartesian local(camera.eye.latitude, camera.eye.longitude, camera.eye.height);
    const double h = camera.heading * kRadian, p = camera.pitch * kRadian, distance = 5000;
    GeodeticPoint ahead, right;
    local.Reverse(distance * std::cos(p) * std::sin(h), distance * std::cos(p) * std::cos(h),
                  distance * std::sin(p), ahead.latitude, ahead.longitude, ahead.height);
    const Vector3 at = view.toView(toEarthCentred(kWgs84, ahead));
    RC_ASSERT(std::abs(at.x - distance) < 1e-6);
    RC_ASSERT(std::abs(at.y) < 1e-3 && std::abs(at.z) < 1e-3);
    local.Reverse(distance * std::cos(h), -distance * std::sin(h), 0, right.latitude, right.longitude,
                  right.height);
    RC_ASSERT(std::abs(view.toView(toEarthCentred(kWgs84, right)).y / 320 - distance) < 1e-6);
  }));
}

TEST(Camera, positive_roll_puts_the_right_wing_down) {
  Camera camera;
  camera.eye = {45, 7, 1000};
  const Vector3 up =
      normalized(toEarthCentred(kWgs84, {45, 7, 2000}) - toEarthCentred(kWgs84, {45, 7, 1000}));
  camera.roll = 30;
  const ViewTransform view = makeViewTransform(camera, kWgs84);
  EXPECT_NEAR(dot(view.right, up), -0.5, 1e-9);
  EXPECT_NEAR(dot(view.down, up), -std::cos(30 * kRadian), 1e-9);
}

TEST(Camera, field_of_view_spans_the_picture_from_border_to_border) {
  Camera camera;
  camera.width = 200;
  camera.height = 100;
  camera.field_of_view = 90;
  const ViewTransform view = makeViewTransform(camera, kWgs84);
  EXPECT_DOUBLE_EQ(view.centre_j, 99.5);
  EXPECT_DOUBLE_EQ(view.centre_i, 49.5);
  // 45 degrees to the right is half a pixel beyond the last pixel's centre.
  EXPECT_NEAR(view.centre_j + view.pixels, 199.5, 1e-9);
}

TEST(Camera, ray_and_projection_are_inverse) {
  Camera camera;
  camera.eye = {-12, 100, 300};
  camera.heading = 77;
  camera.pitch = -10;
  const ViewTransform view = makeViewTransform(camera, kWgs84);
  const Vector3 p = view.toView(view.eye + view.ray(17.25, 600.5) * 4321);
  EXPECT_NEAR(p.x, 4321, 1e-6);
  EXPECT_NEAR(view.centre_j + p.y / p.x, 17.25, 1e-7);
  EXPECT_NEAR(view.centre_i + p.z / p.x, 600.5, 1e-7);
}

TEST(WholeAreaCamera, shows_the_whole_area_and_wastes_little) {
  const AreaHeader areas[] = {areaOf(-122, 46, -121, 47, 200, 4390),   areaOf(86, 27, 88, 29, 100, 8800),
                              areaOf(179.5, -17, 180.5, -16, 0, 1200), areaOf(0, 89, 90, 90, 0, 100),
                              areaOf(10, -90, 40, -89.5, 0, 100),      areaOf(9, 0, 10, 1, 0, 1),
                              areaOf(5, 40, 5.01, 40.2, 0, 50)};
  const int sizes[][2] = {{1280, 720}, {300, 900}, {512, 512}};
  for (const AreaHeader& area : areas) {
    for (const auto& size : sizes) {
      const Camera camera = wholeAreaCamera(area, size[0], size[1], 60);
      const ViewTransform view = makeViewTransform(camera, kWgs84);
      double largest = 0;
      for (int step_y = 0; step_y <= 2; ++step_y) {
        for (int step_x = 0; step_x <= 2; ++step_x) {
          for (const double height : {area.lowest_height, area.highest_height}) {
            const Vector3 p = view.toView(
                toEarthCentred(kWgs84, {area.south + (area.north - area.south) * step_y / 2,
                                        area.west + (area.east - area.west) * step_x / 2, height}));
            ASSERT_GT(p.x, 0);
            largest = std::max(
                {largest, std::abs(p.y / p.x) / (size[0] / 2.0), std::abs(p.z / p.x) / (size[1] / 2.0)});
          }
        }
      }
      EXPECT_LT(largest, 0.97) << area.west << " " << area.south << " " << size[0];
      EXPECT_GT(largest, 0.94) << area.west << " " << area.south << " " << size[0];
    }
  }
}

TEST(WholeAreaCamera, looks_north_from_the_south) {
  const Camera camera = wholeAreaCamera(areaOf(-122, 46, -121, 47, 200, 4390), 1280, 720, 60);
  EXPECT_LT(camera.eye.latitude, 46.5);
  EXPECT_NEAR(camera.eye.longitude, -121.5, 1e-9);
  EXPECT_NEAR(camera.heading, 0, 1e-9);
  EXPECT_NEAR(camera.pitch, -40, 8);
}

}  // namespace
}  // namespace deltaz
