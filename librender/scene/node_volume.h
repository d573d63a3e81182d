// Where everything a node draws lies: inside a ball and between two parallel planes across the vertical. The
// ball alone, which a record stores, is as high as the node is wide; ground is flat beside that, and the
// planes say so.
//
// The upper plane touches the surface of the node's greatest height: points no higher lie inside a convex
// body, whose support function is known. The lower one stands as much below the surface of its least height
// as that surface falls within the ball: it curves no more than a ball of radius R, which touches it from
// inside (Blaschke's rolling theorem), so points outside it stand off the plane at the touching point by
// R - sqrt(R^2 - d^2) at most, d the distance from the axis. Facets between posts lie in the volume as the
// posts do, since it is convex. Thread-safety: pure functions.
#pragma once

#include <array>

#include "libdb/access/database.h"
#include "libdb/access/vector3.h"

namespace deltaz {

struct NodeVolume {
  Vector3 centre;  // Earth-centred, metres
  double radius = 0;
  Vector3 up;                // unit vector: the ellipsoid's normal near the centre
  double low = 0, high = 0;  // of dot(up, p - centre), metres; within +-radius
  double horizontal = 0;     // largest distance of a point from the vertical through the centre, metres
  double normal_spread = 2;  // |normal - up| of the ellipsoid normals at all points, at most
};

// The volume of a terrain node. `heights_hold`: the record's heights are those of all it draws; false where
// seams do more than the node's own posts (SeamState::kTouched), whose faces only the ball holds.
NodeVolume volumeOf(const Node& node, const GridGeometry& geometry, bool heights_hold);

// The largest dot(direction, p - centre) of its points; `direction` is a unit vector.
double reachAlong(const NodeVolume& volume, const Vector3& direction);

// No point of it is nearer to `eye` than this.
double leastDistance(const NodeVolume& volume, const Vector3& eye);

// The corners of a box that holds it, with two sides across the direction from `eye`.
std::array<Vector3, 8> boxAround(const NodeVolume& volume, const Vector3& eye);

}  // namespace deltaz
