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

namespace {

struct SineCosine {
  double sine = 0, cosine = 1;
};

SineCosine sineCosine(double degrees) {
  SineCosine result;
  GeographicLib::Math::sincosd(degrees, result.sine, result.cosine);
  return result;
}

// sin(to) - sin(from) and cos(to) - cos(from), as products of half sum and half difference.
SineCosine stepOf(double from_degrees, double to_degrees) {
  const SineCosine middle = sineCosine(0.5 * (from_degrees + to_degrees));
  const double half_difference = sineCosine(0.5 * (to_degrees - from_degrees)).sine;
  return {2 * middle.cosine * half_difference, -2 * middle.sine * half_difference};
}

}  // namespace

RowStep rowStep(const EllipsoidShape& ellipsoid, double from_degrees, double to_degrees) {
  const double f = flattening(ellipsoid);
  const double e2 = f * (2 - f);
  const SineCosine from = sineCosine(from_degrees);
  const SineCosine to = sineCosine(to_degrees);
  const SineCosine step = stepOf(from_degrees, to_degrees);
  const double from_root = std::sqrt(1 - e2 * from.sine * from.sine);
  const double to_root = std::sqrt(1 - e2 * to.sine * to.sine);
  // N = semi-major / root, and its change, where the difference of the roots' squares is e2 (to^2 - from^2)
  // of the sines.
  const double to_n = ellipsoid.semi_major_axis / to_root;
  const double n_step = ellipsoid.semi_major_axis * e2 * step.sine * (to.sine + from.sine) /
                        (from_root * to_root * (from_root + to_root));
  return {to_n * step.cosine + n_step * from.cosine, step.cosine,
          (1 - e2) * (to_n * step.sine + n_step * from.sine), step.sine};
}

ColumnStep columnStep(double from_degrees, double to_degrees) {
  const SineCosine step = stepOf(from_degrees, to_degrees);
  return {step.cosine, step.sine};
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
