// Where the surface drawn at a level lies over a place: the judge of stored errors. Deliberately not the
// builder's way: every facet near the place is tried, and its plane is intersected by solving three equations
// in extended precision. Internal to libdb/check and its tests. Thread-safety: const members from any thread.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "libdb/access/grid_geometry.h"
#include "libdb/check/full_grid.h"

namespace deltaz {

class SurfaceProbe {
 public:
  // The surface of level `level` over and around these level-0 posts. `full` and `geometry` must outlive it.
  SurfaceProbe(const FullGrid& full, const GridGeometry& geometry, int level, PostRange columns,
               PostRange rows);

  // Height above the ellipsoid, along `up` from `foot`, of the facet over a place that lies, in plan, at
  // level-0 position (column, row). Nothing if no facet of the level is drawn there in plan. Edges bow in
  // plan, so a neighbouring facet is taken where the line meets that one; beside the edge of what is drawn
  // the plane of the last facet is continued.
  std::optional<double> heightOver(double column, double row, const Vector3& foot, const Vector3& up) const;

  // Earth-centred position of a valid post near, and whether a facet is drawn; indices of the level.
  const Vector3& position(std::int64_t column, std::int64_t row) const {
    return positions_[index(column, row)];
  }
  bool isDrawn(std::int64_t column, std::int64_t row, bool top) const;

 private:
  struct Hit {
    long double height = 0;
    long double inside = -1e30L;  // least barycentric weight
    bool met = false;
  };
  std::size_t index(std::int64_t column, std::int64_t row) const {
    return static_cast<std::size_t>((row - rows_.begin) * columns_.size() + (column - columns_.begin));
  }
  Hit meet(std::int64_t column, std::int64_t row, bool top, const Vector3& foot, const Vector3& up) const;

  std::int64_t step_;
  PostRange columns_, rows_;  // indices of the level
  std::vector<Vector3> positions_;
  std::vector<std::uint8_t> valid_;
};

}  // namespace deltaz
