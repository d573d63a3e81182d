// Where a place on the ellipsoid lies in a grid: fractional level-0 post indices. Thread-safety: const
// members from any thread.
#pragma once

#include <optional>

#include "libdb/access/grid_geometry.h"

namespace deltaz {

// Cell (column, row) and the place within it, 0 <= x, y < 1. Places within kSnap of a line of posts, or of a
// cell's diagonal, are on it exactly.
struct GridPlace {
  std::int64_t column = 0, row = 0;
  double x = 0, y = 0;
  bool operator==(const GridPlace&) const = default;
};

class GridLocator {
 public:
  static constexpr double kSnap = 1e-6;  // posts

  explicit GridLocator(const GridGeometry& geometry) : geometry_(geometry) {}

  // Nothing for places far outside the grid. `from` gives the place its degrees where it stands on a geodetic
  // grid's post, exactly.
  std::optional<GridPlace> locatePost(const GridGeometry& from, std::int64_t column, std::int64_t row) const;
  std::optional<GridPlace> locate(const Vector3& foot) const;

  static GridPlace snapped(double u, double v);

 private:
  std::optional<GridPlace> locateDegrees(double latitude, double longitude) const;
  std::optional<GridPlace> locateProjected(const Vector3& foot) const;

  const GridGeometry& geometry_;
};

}  // namespace deltaz
