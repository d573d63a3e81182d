#include "librender/raster/texture_planes.h"

#include <algorithm>
#include <cmath>

namespace deltaz {
namespace {

ScreenPlane combination(const ScreenPlane& a, double times_a, const ScreenPlane& b, double times_b) {
  return {a.value * times_a + b.value * times_b, a.per_j * times_a + b.per_j * times_b,
          a.per_i * times_a + b.per_i * times_b};
}

}  // namespace

// The first vertex is the origin, so only the other two count, each with its weight.
TexturePlanes texturePlanes(const FacePlanes& face) {
  const auto& [second, third] = face.texture_steps;
  return {face.texture, combination(face.weight1, second.column, face.weight2, third.column),
          combination(face.weight1, second.row, face.weight2, third.row)};
}

double TextureFootprint::size() const {
  // Not std::hypot, whose last digit is the library's.
  const auto squared = [](const GridCoordinates& step) {
    return step.column * step.column + step.row * step.row;
  };
  return std::sqrt(std::max(squared(per_j), squared(per_i)));
}

TextureFootprint footprintAt(const FacePlanes& face, double j, double i, double inverse_u) {
  const TexturePlanes planes = texturePlanes(face);
  const double dj = j - face.anchor_j, di = i - face.anchor_i, u = 1 / inverse_u;
  const double column = planes.column.at(dj, di) * u, row = planes.row.at(dj, di) * u;
  TextureFootprint footprint;
  footprint.per_j = {(planes.column.per_j - column * face.inverse_u.per_j) * u,
                     (planes.row.per_j - row * face.inverse_u.per_j) * u};
  footprint.per_i = {(planes.column.per_i - column * face.inverse_u.per_i) * u,
                     (planes.row.per_i - row * face.inverse_u.per_i) * u};
  const auto& [second, third] = face.texture_steps;
  const auto within = [](double value, double a, double b) {
    return std::clamp(value, std::min({0.0, a, b}), std::max({0.0, a, b}));
  };
  footprint.place = {planes.origin.column + within(column, second.column, third.column),
                     planes.origin.row + within(row, second.row, third.row)};
  return footprint;
}

}  // namespace deltaz
