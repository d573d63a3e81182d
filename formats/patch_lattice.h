// The control points that place the posts of a projected grid: Earth-centred points of the ellipsoid's
// surface on a lattice of global grid indices. Specified in patch_lattice.md.
//
// Between them positions are interpolated by tensor polynomials (libdb/access/patch_surface.h), a patch of
// degree + 1 points a side at a time; neighbouring patches share the points on their border, so that both
// give a post on it the same position to the last bit, and so does every level of detail. Errors: kInvalid
// with kHgtPatches. Thread-safety: plain values.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "formats/area.h"
#include "formats/error.h"

namespace deltaz {

struct PatchLattice {
  PatchPlacement placement;
  // x, y, z in metres of every control point, row by row from the south-west.
  std::vector<double> controls;

  std::int64_t pointColumns() const { return placement.columns * placement.degree + 1; }
  std::int64_t pointRows() const { return placement.rows * placement.degree + 1; }
  // Level-0 cells between control points.
  std::int64_t step() const { return placement.cells / placement.degree; }
};

// One row of control points as a block of the patches file, and back. `points` is how many it must hold.
std::vector<std::byte> encodePatchRow(std::span<const double> row);
Result<std::vector<double>> decodePatchRow(std::span<const std::byte> bytes, std::int64_t points,
                                           const std::string& where);

}  // namespace deltaz
