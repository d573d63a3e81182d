// Where the posts of a projected grid lie on the ellipsoid: tensor Lagrange interpolation between the control
// points of formats/patch_lattice.h.
//
// The weights of a control point are exactly 1 at its own index and 0 at the others', so posts on the border
// of two patches get the same bits from both. The error against the exact transformation was measured when
// the lattice was made (PatchPlacement::error, at most kPatchErrorBound). Cost: about 15 multiply-adds a post
// in a row of posts. Thread-safety: pure functions.
#pragma once

#include <cstdint>
#include <vector>

#include "formats/patch_lattice.h"
#include "libdb/access/vector3.h"
#include "libdb/access/vector_lists.h"

namespace deltaz {

// What a builder accepts as interpolation error: a tenth of a millimetre.
inline constexpr double kPatchErrorBound = 1e-4;  // metres

// Earth-centred metres of level-0 post (column, row). Outside the lattice the nearest patch is extended.
Vector3 patchPosition(const PatchLattice& lattice, std::int64_t column, std::int64_t row);

// The same for every `step`-th post: columns first_column, first_column + step, ... (`columns` of them), rows
// alike, row by row.
std::vector<Vector3> patchPositions(const PatchLattice& lattice, std::int64_t first_column,
                                    std::int64_t columns, std::int64_t first_row, std::int64_t rows,
                                    std::int64_t step);
// The same, as lists; `positions` is overwritten.
void patchPositions(const PatchLattice& lattice, std::int64_t first_column, std::int64_t columns,
                    std::int64_t first_row, std::int64_t rows, std::int64_t step, VectorLists& positions);

}  // namespace deltaz
