// A tile as the report saw it: a flat grid of evenly spaced posts in the tangent frame at the tile's middle.
// Post (i, j) with height h lies at
//   origin + east * (i - middle_column) + north * (j - middle_row) + up * (metres(h) - base_height).
//
// On a geodetic grid this is the first-order Taylor expansion of the exact position about the tile's middle,
// so what it leaves out is bounded by second derivatives (planarityBound). On a projected grid east and north
// are secants through the tile's middle row and column, and the bound is measured at every post.
// Thread-safety: pure functions.
#pragma once

#include <cstdint>

#include "libdb/access/grid_geometry.h"
#include "libdb/access/terrain_tile.h"
#include "libdb/access/vector3.h"

namespace deltaz {

struct PlanarGrid {
  Vector3 origin;       // Earth-centred metres of the tile's middle, base_height above the ellipsoid
  Vector3 east, north;  // Earth-centred metres from post to post
  Vector3 up;           // unit vector, the ellipsoid normal at the middle
  double middle_column = 0, middle_row = 0;  // in posts from the tile's post (0, 0)
  std::int32_t base = 0;                     // quanta, the middle of the valid posts' heights
  double base_height = 0;                    // the same in metres
  std::int64_t height_reach = 0;             // quanta: largest distance of a valid post from `base`
};

// Pre: tile.columns, tile.rows >= 1; on a projected grid the geometry has its patches.
PlanarGrid planarGridOf(const TerrainTile& tile, const GridGeometry& geometry);

// Metres no valid post of the tile is farther from its place on the planar grid than, the arithmetic being
// exact. With half extents p (latitude) and l (longitude) in radians, heights within k of the base, M and N
// the radii of curvature and F(lat, lon, h) the exact position, Taylor's remainder is at most
//   (|F_pp| p^2 + 2 |F_pl| p l + |F_ll| l^2) / 2 + |F_ph| p k + |F_lh| l k,
//   |F_pp| <= M + h + |dM/dlat|,  |F_pl| = (M + h) |sin lat|,  |F_ll| = (N + h) cos lat,
//   |F_ph| = 1,  |F_lh| = cos lat,
// each taken at its largest over the tile. For a square tile at the equator and heights at the base that is
// the familiar sag of a tangent plane, d^2 / (2 R).
double planarityBound(const TerrainTile& tile, const GridGeometry& geometry);

}  // namespace deltaz
