#include "libdb/access/model.h"

#include <GeographicLib/Geocentric.hpp>
#include <GeographicLib/LocalCartesian.hpp>
#include <cmath>
#include <gtest/gtest.h>
#include <numbers>
#include <rapidcheck/gtest.h>

namespace deltaz {
namespace {

// A number of -limit .. limit in steps of limit / 1000.
double within(double limit) {
  return *rc::gen::inRange(-1000, 1001) * limit / 1000;
}

Vector3 arbitraryPoint(double limit) {
  return {within(limit), within(limit), within(limit)};
}

// Rotations about the three axes, one after the other.
ModelTransform rotation(double a, double b, double c) {
  const ModelTransform about_x = {1,           0, 0, 0, std::cos(a), std::sin(a), 0, -std::sin(a),
                                  std::cos(a), 0, 0, 0};
  const ModelTransform about_y = {std::cos(b), 0, -std::sin(b), 0, 1, 0,
                                  std::sin(b), 0, std::cos(b),  0, 0, 0};
  const ModelTransform about_z = {std::cos(c), std::sin(c), 0, -std::sin(c), std::cos(c), 0, 0, 0, 1,
                                  0,           0,           0};
  return concatenate(concatenate(about_x, about_y), about_z);
}

ModelTransform arbitraryTransform() {
  ModelTransform m{};
  for (double& value : m) value = within(3);
  return m;
}

TEST(ModelTransform, a_quarter_turn_takes_x_to_y) {
  const ModelTransform turn = rotation(0, 0, std::numbers::pi / 2);
  const Vector3 to = transformPoint(turn, {1, 0, 0});
  EXPECT_NEAR(to.x, 0, 1e-15);
  EXPECT_NEAR(to.y, 1, 1e-15);
  const ModelTransform shift = {1, 0, 0, 0, 1, 0, 0, 0, 1, 10, 20, 30};
  EXPECT_EQ(transformPoint(shift, {1, 2, 3}), (Vector3{11, 22, 33}));
}

RC_GTEST_PROP(ModelTransform, concatenating_is_one_after_the_other, ()) {
  const ModelTransform a = arbitraryTransform(), b = arbitraryTransform();
  const Vector3 p = arbitraryPoint(10);
  const Vector3 both = transformPoint(concatenate(a, b), p);
  const Vector3 one_by_one = transformPoint(b, transformPoint(a, p));
  RC_ASSERT(length(both - one_by_one) < 1e-12 * 1000);
}

RC_GTEST_PROP(ModelTransform, no_vector_is_stretched_more_than_the_largest_stretch, ()) {
  ModelTransform m = arbitraryTransform();
  m[9] = m[10] = m[11] = 0;
  const double largest = largestStretch(m);
  const Vector3 p = arbitraryPoint(1);
  RC_ASSERT(length(transformPoint(m, p)) <= largest * length(p) + 1e-13);
  // And one is stretched as much: the power method finds it.
  const ModelTransform transposed = {m[0], m[3], m[6], m[1], m[4], m[7], m[2], m[5], m[8], 0, 0, 0};
  const ModelTransform there_and_back = concatenate(m, transposed);
  Vector3 v{0.61, 0.53, 0.59};
  for (int k = 0; k < 3000 && length(v) > 0; ++k) {
    v = transformPoint(there_and_back, v);
    if (length(v) > 0) v = normalized(v);
  }
  if (length(v) == 0) return;
  RC_ASSERT(length(transformPoint(m, v)) >= largest * (1 - 1e-3) - 1e-12);
}

TEST(ModelTransform, the_largest_stretch_of_known_ones) {
  EXPECT_NEAR(largestStretch(kIdentityTransform), 1, 1e-11);
  EXPECT_GE(largestStretch(kIdentityTransform), 1);
  EXPECT_NEAR(largestStretch({2, 0, 0, 0, -5, 0, 0, 0, 3, 9, 9, 9}), 5, 1e-10);
  // A shear by 1: the golden ratio.
  EXPECT_NEAR(largestStretch({1, 0, 0, 1, 1, 0, 0, 0, 1, 0, 0, 0}), (1 + std::sqrt(5.0)) / 2, 1e-10);
  EXPECT_EQ(largestStretch({}), 0);
  for (int k = 0; k < 100; ++k) {
    const double stretch = largestStretch(rotation(0.1 * k, 0.37 * k, 0.73 * k));
    EXPECT_NEAR(stretch, 1, 1e-11);
    EXPECT_GE(stretch, 1) << "rounding must not shrink a sphere";
  }
}

// GeographicLib's local system at the placement: x east, y north, z up.
RC_GTEST_PROP(PlacementTransform, puts_models_where_geographiclib_does, ()) {
  Placement placement;
  placement.latitude = within(90);
  placement.longitude = within(180);
  placement.height = within(9000);
  placement.heading = std::abs(within(359));
  const std::array<double, 3> anchor = {within(50), within(50), within(50)};
  const Vector3 point = arbitraryPoint(200);
  const EllipsoidShape ellipsoid;
  const GeographicLib::Geocentric earth(ellipsoid.semi_major_axis, 1 / ellipsoid.inverse_flattening);
  const GeographicLib::LocalCartesian local(placement.latitude, placement.longitude, placement.height, earth);
  // Heading turns clockwise seen from above.
  const double heading = placement.heading * std::numbers::pi / 180;
  const double x = point.x - anchor[0], y = point.y - anchor[1], z = point.z - anchor[2];
  const double east = x * std::cos(heading) + y * std::sin(heading);
  const double north = -x * std::sin(heading) + y * std::cos(heading);
  double latitude = 0, longitude = 0, height = 0, ex = 0, ey = 0, ez = 0;
  local.Reverse(east, north, z, latitude, longitude, height);
  earth.Forward(latitude, longitude, height, ex, ey, ez);
  const Vector3 placed = transformPoint(placementTransform(placement, anchor, ellipsoid), point);
  RC_ASSERT(length(placed - Vector3{ex, ey, ez}) < 1e-7);
}

TEST(PlacementTransform, the_anchor_stands_at_the_position_and_y_points_to_the_heading) {
  const EllipsoidShape ellipsoid;
  const Placement placement{1, 0, 46.85, -121.76, 1000, 90, false, 0};
  const ModelTransform m = placementTransform(placement, {1, 2, 3}, ellipsoid);
  const Vector3 at = toEarthCentred(ellipsoid, {46.85, -121.76, 1000});
  EXPECT_LT(length(transformPoint(m, {1, 2, 3}) - at), 1e-8);
  const GeodeticPoint ahead = toGeodetic(ellipsoid, transformPoint(m, {1, 102, 3}));
  EXPECT_NEAR(ahead.latitude, 46.85, 1e-5);
  EXPECT_NEAR((ahead.longitude + 121.76) * 111320 * std::cos(46.85 * std::numbers::pi / 180), 100, 0.5);
  const GeodeticPoint above = toGeodetic(ellipsoid, transformPoint(m, {1, 2, 13}));
  EXPECT_NEAR(above.height, 1010, 1e-6);
}

}  // namespace
}  // namespace deltaz
