#include "libdb/access/earth.h"

#include <algorithm>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

namespace deltaz {
namespace {

constexpr double kSeparableError = 4e-9;  // metres, stated in earth.h

RC_GTEST_PROP(Earth, separable_form_agrees_with_geographiclib, ()) {
  const double latitude =
      *rc::gen::element(90.0, -90.0, 0.0, 1e-9, *rc::gen::inRange(-90000, 90001) / 1000.0);
  const double longitude =
      *rc::gen::element(180.0, -180.0, 0.0, 540.0, *rc::gen::inRange(-180000, 540001) / 1000.0);
  const double height = *rc::gen::inRange(-11000, 9000);
  const EllipsoidShape ellipsoid =
      *rc::gen::element(EllipsoidShape{}, EllipsoidShape{6378206.4, 294.9786982}, EllipsoidShape{6371000, 0});
  const Vector3 fast = earthCentred(rowConstants(ellipsoid, latitude), columnConstants(longitude), height);
  const Vector3 exact = toEarthCentred(ellipsoid, {latitude, longitude, height});
  RC_ASSERT(length(fast - exact) <= kSeparableError);
}

TEST(Earth, poles_and_quarter_meridians_are_exact) {
  const EllipsoidShape ellipsoid;
  const Vector3 pole = earthCentred(rowConstants(ellipsoid, 90), columnConstants(123), 0);
  EXPECT_EQ(pole.x, 0);
  EXPECT_EQ(pole.y, 0);
  const Vector3 east = earthCentred(rowConstants(ellipsoid, 0), columnConstants(90), 0);
  EXPECT_EQ(east.x, 0);
  EXPECT_EQ(east.z, 0);
  EXPECT_EQ(columnConstants(180).sine, columnConstants(-180).sine * -1) << "both sides of the antimeridian";
  EXPECT_EQ(columnConstants(180).cosine, columnConstants(-180).cosine);
}

RC_GTEST_PROP(Earth, steps_lead_from_one_row_and_column_to_another, ()) {
  const EllipsoidShape ellipsoid;
  const double from = *rc::gen::inRange(-90000, 90001) / 1000.0;
  const double to = std::clamp(from + *rc::gen::inRange(-2000, 2001) / 1000.0, -90.0, 90.0);
  const RowConstants a = rowConstants(ellipsoid, from), b = rowConstants(ellipsoid, to);
  const RowStep row = rowStep(ellipsoid, from, to);
  RC_ASSERT(std::abs(a.a + row.a - b.a) <= kSeparableError);
  RC_ASSERT(std::abs(a.b + row.b - b.b) <= 1e-15);
  RC_ASSERT(std::abs(a.c + row.c - b.c) <= kSeparableError);
  RC_ASSERT(std::abs(a.s + row.s - b.s) <= 1e-15);
  const ColumnStep column = columnStep(2 * from, 2 * to);
  RC_ASSERT(std::abs(columnConstants(2 * from).cosine + column.cosine - columnConstants(2 * to).cosine) <=
            1e-15);
  RC_ASSERT(std::abs(columnConstants(2 * from).sine + column.sine - columnConstants(2 * to).sine) <= 1e-15);
}

RC_GTEST_PROP(Earth, geodetic_and_earth_centred_are_inverse, ()) {
  const EllipsoidShape ellipsoid;
  const GeodeticPoint point{*rc::gen::inRange(-89999, 90000) / 1000.0,
                            *rc::gen::inRange(-179999, 180000) / 1000.0,
                            static_cast<double>(*rc::gen::inRange(-10000, 1000000))};
  const GeodeticPoint back = toGeodetic(ellipsoid, toEarthCentred(ellipsoid, point));
  RC_ASSERT(std::abs(back.latitude - point.latitude) < 1e-12);
  RC_ASSERT(std::abs(back.longitude - point.longitude) < 1e-9);
  RC_ASSERT(std::abs(back.height - point.height) < 1e-8);
}

}  // namespace
}  // namespace deltaz
