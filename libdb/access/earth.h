// Positions on the curved Earth. On a geodetic grid Earth-centred coordinates are separable: a term of the
// row, a term of the column, and the height.
//   x = (a + b h) cos(lon),  y = (a + b h) sin(lon),  z = c + s h
//   a = N cos(lat), b = cos(lat), c = N (1 - e^2) sin(lat), s = sin(lat),  N = semi-major / sqrt(1 - e^2 s^2)
// Exact but for the rounding of doubles (below 4e-9 m). Sines and cosines of degrees are GeographicLib's, so
// that the poles and the quarter meridians are exact. Thread-safety: pure functions.
#pragma once

#include "formats/area.h"
#include "libdb/access/vector3.h"

namespace deltaz {

struct RowConstants {
  double a = 0, b = 0, c = 0, s = 0;
};
struct ColumnConstants {
  double cosine = 1, sine = 0;  // of the longitude
};

RowConstants rowConstants(const EllipsoidShape& ellipsoid, double latitude_degrees);
ColumnConstants columnConstants(double longitude_degrees);

// Earth-centred metres of the point `height` metres above the ellipsoid.
inline Vector3 earthCentred(const RowConstants& row, const ColumnConstants& column, double height) {
  const double distance = row.a + row.b * height;
  return {distance * column.cosine, distance * column.sine, row.c + row.s * height};
}

// What row and column constants change by from one latitude or longitude to another, each to a few units in
// its own last place, however close the two are: subtracting the constants would leave 1e-9 m of noise, which
// is as much as the spacing of posts beside a pole.
struct RowStep {
  double a = 0, b = 0, c = 0, s = 0;
};
struct ColumnStep {
  double cosine = 0, sine = 0;
};
RowStep rowStep(const EllipsoidShape& ellipsoid, double from_degrees, double to_degrees);
ColumnStep columnStep(double from_degrees, double to_degrees);

// The ellipsoid normal (unit vector, up).
inline Vector3 upVector(const RowConstants& row, const ColumnConstants& column) {
  return {row.b * column.cosine, row.b * column.sine, row.s};
}

struct GeodeticPoint {
  double latitude = 0, longitude = 0;  // degrees
  double height = 0;                   // metres above the ellipsoid
};

// GeographicLib's Geocentric, both ways.
Vector3 toEarthCentred(const EllipsoidShape& ellipsoid, const GeodeticPoint& point);
GeodeticPoint toGeodetic(const EllipsoidShape& ellipsoid, const Vector3& position);

}  // namespace deltaz
