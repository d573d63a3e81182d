// Where posts really are, in extended precision and from nothing but the definition of geodetic coordinates:
// what the doubles and floats under test are measured against.
#pragma once

#include <vector>

#include "libdb/access/grid_geometry.h"
#include "libdb/access/terrain_tile.h"
#include "librender/scene/camera.h"

namespace deltaz {

struct LongVector {
  long double x = 0, y = 0, z = 0;
};

// Earth-centred metres. Degrees are taken as the doubles they are.
LongVector truePosition(const EllipsoidShape& ellipsoid, double latitude, double longitude,
                        long double height);

// View coordinates of an Earth-centred point, V and W divided by view.pixels: metres along the view's unit
// vectors.
LongVector trueView(const ViewTransform& view, const LongVector& position);

// Of every post of the tile, row by row. On a projected grid the lattice's own evaluation counts as the
// truth.
std::vector<LongVector> truePositions(const TerrainTile& tile, const GridGeometry& geometry);

// Distance in metres between a view position (V and W in pixels) and the truth.
double viewError(const ViewTransform& view, const Vector3& position, const LongVector& truth);

// The largest viewError over the tile's valid posts. Infinity if a position is not finite.
double largestError(const TerrainTile& tile, const ViewTransform& view, const std::vector<Vector3>& positions,
                    const std::vector<LongVector>& truth);

}  // namespace deltaz
