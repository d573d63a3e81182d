#include "libdb/access/earth.h"

#include <GeographicLib/Geocentric.hpp>
#include <GeographicLib/Math.hpp>

namespace deltaz {

namespace {

double flattening(const EllipsoidShape& ellipsoid) {
  return ellipsoid.inverse_flattening == 0 ? 0.0 : 1.0 / ellipsoid.inverse_flattening;
}

}  // namespace

RowConstants rowConstants(const EllipsoidShape& ellipsoid, double latitude_degrees) {
  double sine = 0;
  double cosine = 1;
  GeographicLib::Math::sincosd(latitude_degrees, sine, cosine);
  const double f = flattening(ellipsoid);
  const double e2 = f * (2 - f);
  const double n = ellipsoid.semi_major_axis / std::sqrt(1 - e2 * sine * sine);
  return {n * cosine, cosine, n * (1 - e2) * sine, sine};
}

ColumnConstants columnConstants(double longitude_degrees) {
  ColumnConstants column;
  GeographicLib::Math::sincosd(longitude_degrees, column.sine, column.cosine);
  return column;
}

Vector3 toEarthCentred(const EllipsoidShape& ellipsoid, const GeodeticPoint& point) {
  const GeographicLib::Geocentric earth(ellipsoid.semi_major_axis, flattening(ellipsoid));
  Vector3 position;
  earth.Forward(point.latitude, point.longitude, point.height, position.x, position.y, position.z);
  return position;
}

GeodeticPoint toGeodetic(const EllipsoidShape& ellipsoid, const Vector3& position) {
  const GeographicLib::Geocentric earth(ellipsoid.semi_major_axis, flattening(ellipsoid));
  GeodeticPoint point;
  earth.Reverse(position.x, position.y, position.z, point.latitude, point.longitude, point.height);
  return point;
}

}  // namespace deltaz
