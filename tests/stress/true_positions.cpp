#include "tests/stress/true_positions.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace deltaz {
namespace {

struct LongSineCosine {
  long double sine = 0, cosine = 1;
};

// Quadrants are taken off exactly, so that poles and quarter meridians are exact.
LongSineCosine ofDegrees(long double degrees) {
  int quadrant = 0;
  const long double rest = std::remquo(degrees, 90.0L, &quadrant) * (std::numbers::pi_v<long double> / 180);
  const long double s = std::sin(rest), c = std::cos(rest);
  switch (quadrant & 3) {
    case 0:
      return {s, c};
    case 1:
      return {c, -s};
    case 2:
      return {-s, -c};
    default:
      return {-c, s};
  }
}

long double dotLong(const Vector3& a, const LongVector& b) {
  return static_cast<long double>(a.x) * b.x + static_cast<long double>(a.y) * b.y +
         static_cast<long double>(a.z) * b.z;
}

}  // namespace

LongVector truePosition(const EllipsoidShape& ellipsoid, double latitude, double longitude,
                        long double height) {
  const LongSineCosine lat = ofDegrees(latitude), lon = ofDegrees(longitude);
  const long double f = ellipsoid.inverse_flattening == 0
                            ? 0.0L
                            : 1.0L / static_cast<long double>(ellipsoid.inverse_flattening);
  const long double e2 = f * (2 - f);
  const long double n =
      static_cast<long double>(ellipsoid.semi_major_axis) / std::sqrt(1 - e2 * lat.sine * lat.sine);
  const long double distance = (n + height) * lat.cosine;
  return {distance * lon.cosine, distance * lon.sine, (n * (1 - e2) + height) * lat.sine};
}

LongVector trueView(const ViewTransform& view, const LongVector& position) {
  const LongVector d{position.x - static_cast<long double>(view.eye.x),
                     position.y - static_cast<long double>(view.eye.y),
                     position.z - static_cast<long double>(view.eye.z)};
  return {dotLong(view.forward, d), dotLong(view.right, d), dotLong(view.down, d)};
}

std::vector<LongVector> truePositions(const TerrainTile& tile, const GridGeometry& geometry) {
  const GridHeader& header = geometry.header();
  const std::int64_t step = std::int64_t{1} << tile.level;
  std::vector<LongVector> positions;
  for (int j = 0; j < tile.rows; ++j) {
    for (int i = 0; i < tile.columns; ++i) {
      const std::int64_t column = (tile.first_column + i) * step, row = (tile.first_row + j) * step;
      const long double height = static_cast<long double>(tile.height(i, j)) *
                                 static_cast<long double>(header.quantum.numerator) /
                                 static_cast<long double>(header.quantum.denominator);
      if (geometry.isGeodetic()) {
        positions.push_back(
            truePosition(header.ellipsoid, geometry.latitude(row), geometry.longitude(column), height));
      } else {
        const PostPlace place = geometry.placeAt(column, row);
        positions.push_back(
            {static_cast<long double>(place.foot.x) + static_cast<long double>(place.up.x) * height,
             static_cast<long double>(place.foot.y) + static_cast<long double>(place.up.y) * height,
             static_cast<long double>(place.foot.z) + static_cast<long double>(place.up.z) * height});
      }
    }
  }
  return positions;
}

double viewError(const ViewTransform& view, const Vector3& position, const LongVector& truth) {
  const auto pixels = static_cast<long double>(view.pixels);
  const LongVector should = trueView(view, truth);
  const long double u = static_cast<long double>(position.x) - should.x;
  const long double v = static_cast<long double>(position.y) / pixels - should.y;
  const long double w = static_cast<long double>(position.z) / pixels - should.z;
  const auto error = static_cast<double>(std::sqrt(u * u + v * v + w * w));
  return std::isfinite(error) ? error : std::numeric_limits<double>::infinity();
}

double largestError(const TerrainTile& tile, const ViewTransform& view, const std::vector<Vector3>& positions,
                    const std::vector<LongVector>& truth) {
  double largest = 0;
  std::size_t post = 0;
  for (int j = 0; j < tile.rows; ++j) {
    for (int i = 0; i < tile.columns; ++i, ++post) {
      if (tile.isValid(i, j)) largest = std::max(largest, viewError(view, positions[post], truth[post]));
    }
  }
  return largest;
}

}  // namespace deltaz
