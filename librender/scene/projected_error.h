// How far, in pixels, displacements in space move points on the screen.
//
// A point p at depth U whose ray has the tangent t (p = U (1, t)) and that is displaced by d n, n a unit
// vector with components nu along the view axis and nq across it, moves by
//   |d| |nq - t nu| / (U + d nu) <= |d| sqrt(1 + t^2) sin(angle between n and the ray) / (U - |d nu|)
// tangents, and sqrt(1 + t^2) / U = 1 / (|p| cos^2 s), s the ray's slant from the view axis. A displacement
// along the ray moves nothing: heights seen from above hardly move, plan places seen from the side do.
// Bounds are for points in the picture and never too small; infinity where none can be given. Thread-safety:
// pure functions.
#pragma once

#include "librender/scene/camera.h"
#include "librender/scene/node_volume.h"

namespace deltaz {

// Of any displacement of at most `error` metres, of points inside a sphere.
double projectedErrorBound(const ViewTransform& view, const Vector3& centre, double radius, double error);

// Of any displacement of at most `error` metres, of points inside the volume.
double projectedErrorBound(const ViewTransform& view, const NodeVolume& volume, double error);

// Of a displacement along the ellipsoid normal. With v the least vertical and r the horizontal distance of a
// point from the eye, sin(angle) / |p| = r / (r^2 + v^2); what the normals of the volume's points lean from
// its `up` is added to the sine.
double projectedHeightErrorBound(const ViewTransform& view, const NodeVolume& volume, double error);

}  // namespace deltaz
