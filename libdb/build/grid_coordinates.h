// Coordinates of places between the posts of a grid, in the grid's own reference system. Thread-safety: pure.
#pragma once

#include "libdb/access/grid_geometry.h"

namespace deltaz {

// Coordinate at `posts` (level-0 index, any real number) along an axis.
inline double coordinateAt(const GridAxis& axis, const AxisOrigin& origin, double posts) {
  if (axis.exact_spacing) {
    const double step = static_cast<double>(axis.exact_spacing->numerator) /
                        (origin.exact_per_unit * static_cast<double>(axis.exact_spacing->denominator));
    return origin.coordinate + (posts + axis.phase) * step;
  }
  return origin.coordinate + (posts + axis.phase) * axis.spacing;
}

inline double xCoordinateAt(const GridHeader& grid, double column) {
  return coordinateAt(grid.x_axis, grid.kind == "geodetic" ? kLongitudeOrigin : kProjectedOrigin, column);
}
inline double yCoordinateAt(const GridHeader& grid, double row) {
  if (grid.kind != "geodetic") return coordinateAt(grid.y_axis, kProjectedOrigin, row);
  const double latitude = coordinateAt(grid.y_axis, kLatitudeOrigin, row);
  return latitude > 90 ? 90 : latitude < -90 ? -90 : latitude;
}

}  // namespace deltaz
