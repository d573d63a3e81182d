#include "libdb/check/surface_probe.h"

#include <algorithm>
#include <cmath>

namespace deltaz {
namespace {

// How far outside a facet, in barycentric terms, still counts as inside: rounding.
constexpr long double kInside = -1e-9L;
// A triangle is flat to nothing if the sine of its angle is below this.
constexpr long double kNoExtent = 1e-12L;

struct Wide {
  long double x, y, z;
};
Wide wide(const Vector3& v) {
  return {v.x, v.y, v.z};
}
Wide minus(const Wide& a, const Wide& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
long double determinant(const Wide& a, const Wide& b, const Wide& c) {
  return a.x * (b.y * c.z - b.z * c.y) - b.x * (a.y * c.z - a.z * c.y) + c.x * (a.y * b.z - a.z * b.y);
}
long double size(const Wide& a) {
  return std::sqrt(a.x * a.x + a.y * a.y + a.z * a.z);
}

}  // namespace

SurfaceProbe::SurfaceProbe(const FullGrid& full, const GridGeometry& geometry, int level, PostRange columns,
                           PostRange rows)
    : step_(std::int64_t{1} << level),
      columns_{floorDivide(columns.begin, step_) - 1, floorDivide(columns.end - 1, step_) + 3},
      rows_{floorDivide(rows.begin, step_) - 1, floorDivide(rows.end - 1, step_) + 3} {
  const std::vector<PostPlace> places = geometry.postPlaces(level, columns_, rows_);
  positions_.resize(places.size());
  valid_.assign(places.size(), 0);
  for (std::int64_t row = rows_.begin; row < rows_.end; ++row) {
    for (std::int64_t column = columns_.begin; column < columns_.end; ++column) {
      if (!full.isValid(column * step_, row * step_)) continue;
      const std::size_t i = index(column, row);
      valid_[i] = 1;
      positions_[i] = places[i].at(geometry.metres(full.heights[full.index(column * step_, row * step_)]));
    }
  }
}

bool SurfaceProbe::isDrawn(std::int64_t column, std::int64_t row, bool top) const {
  if (column < columns_.begin || column + 1 >= columns_.end || row < rows_.begin || row + 1 >= rows_.end)
    return false;
  return valid_[index(column, row)] != 0 && valid_[index(column + 1, row + 1)] != 0 &&
         valid_[top ? index(column, row + 1) : index(column + 1, row)] != 0;
}

// foot + t up = a + u (b - a) + v (c - a), by Cramer's rule.
SurfaceProbe::Hit SurfaceProbe::meet(std::int64_t column, std::int64_t row, bool top, const Vector3& foot,
                                     const Vector3& up) const {
  Hit hit;
  if (!isDrawn(column, row, top)) return hit;
  const Wide a = wide(position(column, row));
  const Wide ne = wide(position(column + 1, row + 1));
  const Wide third = wide(top ? position(column, row + 1) : position(column + 1, row));
  const Wide b = minus(top ? ne : third, a), c = minus(top ? third : ne, a);
  const Wide direction = wide(up), from = minus(wide(foot), a);
  const long double d = determinant(b, c, direction);
  if (std::abs(d) <= kNoExtent * size(b) * size(c)) return hit;
  const long double u = determinant(from, c, direction) / d;
  const long double v = determinant(b, from, direction) / d;
  hit.height = -determinant(b, c, from) / d;
  hit.inside = std::min({u, v, 1 - u - v});
  hit.met = true;
  return hit;
}

std::optional<double> SurfaceProbe::heightOver(double column, double row, const Vector3& foot,
                                               const Vector3& up) const {
  const double scale = 1.0 / static_cast<double>(step_);
  const double x = column * scale, y = row * scale;
  const auto I = static_cast<std::int64_t>(std::floor(x)), J = static_cast<std::int64_t>(std::floor(y));
  const double a = x - std::floor(x), b = y - std::floor(y);
  // The facets whose closure holds the place in plan. A place on an edge belongs to both sides of it.
  Hit best;
  bool drawn = false;
  const auto consider = [&](std::int64_t i, std::int64_t j, bool top) {
    drawn = drawn || isDrawn(i, j, top);
    if (const Hit hit = meet(i, j, top, foot, up); hit.met && hit.inside > best.inside) best = hit;
  };
  if (a >= b) consider(I, J, false);
  if (b >= a) consider(I, J, true);
  if (b == 0 && a > 0) consider(I, J - 1, true);
  if (a == 0 && b > 0) consider(I - 1, J, false);
  if (!drawn) return std::nullopt;
  if (best.met && best.inside >= kInside) return static_cast<double>(best.height);
  for (std::int64_t j = J - 1; j <= J + 1; ++j) {
    for (std::int64_t i = I - 1; i <= I + 1; ++i) {
      consider(i, j, false);
      consider(i, j, true);
      if (best.met && best.inside >= kInside) return static_cast<double>(best.height);
    }
  }
  if (!best.met) return std::nullopt;
  return static_cast<double>(best.height);
}

}  // namespace deltaz
