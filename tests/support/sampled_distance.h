// Distances between meshes as tests see them: samples, each against every triangle, by a formula of their
// own.
#pragma once

#include "libdb/build/mesh_distance.h"

namespace deltaz {

// By minimising over the plane and the three edges, each on its own.
double distanceToTriangle(const std::array<Vector3, 3>& triangle, const Vector3& p);

// The largest distance from `to` found at the samples of `from`: (steps + 1)(steps + 2)/2 a triangle, corners
// included.
double sampledDistance(const TriangleView& from, const TriangleView& to, int steps);

}  // namespace deltaz
