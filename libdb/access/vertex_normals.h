// Vertex normals after Table 11 of the report (5.1.4.3), corrected: VN ~ sum over the six triangles around a
// vertex of (d1 x d2) / D^p, unnormalised cross products, D the distance from the vertex to the triangle's
// centroid, p = 2. RMS error on a sphere of radius 2000 m with 90 m posts: 0.0282 degree, below p = 0 and p =
// 1; second order.
//
// Triangles with a void or missing post, or of no extent (pole rows), count nothing; a vertex left with none
// gets the fallback. Equal on both sides of a tile border to the last bit, since only global indices and
// heights enter, and on every processor. Thread-safety: pure functions.
#pragma once

#include <array>
#include <vector>

#include "libdb/access/grid_geometry.h"
#include "libdb/access/terrain_tile.h"
#include "libdb/access/tile_posts.h"
#include "libdb/access/vector3.h"

namespace deltaz {

inline constexpr int kNormalExponent = 2;
inline constexpr double kVertexNormalTolerance = 1e-9;  // against an independent evaluation, per component

// Neighbours of a vertex in the order E, NE, N, W, SW, S; the six triangles are (E,NE) (NE,N) (N,W) (W,SW)
// (SW,S) (S,E).
struct VertexNeighbour {
  Vector3 offset;  // neighbour minus vertex
  bool valid = false;
};

// Unit normal of the vertex; `fallback` (unit) where no triangle counts. `exponent` is p; anything but
// kNormalExponent is for measurement.
Vector3 table11Normal(const std::array<VertexNeighbour, 6>& neighbours, const Vector3& fallback,
                      int exponent = kNormalExponent);

// Earth-centred unit normals of a tile's own posts, row by row (columns * rows of them), derived from the
// tile's own level. Void posts get the ellipsoid normal.
std::vector<Vector3> vertexNormals(const TerrainTile& tile, const GridGeometry& geometry);
// The same as lists, of as many posts at a time as the processor takes; `normals` is overwritten.
void vertexNormals(const TilePosts& posts, VectorLists& normals);

}  // namespace deltaz
