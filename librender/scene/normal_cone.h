// Nodes whose faces are all turned away from the eye.
//
// A record stores a cone that holds the normals of all facets of the node and below, those of its seams
// included. A face with normal m through a point p is turned away if dot(m, p - eye) >= 0. With p in the
// node's ball that is at least |centre - eye| cos(angle between axis and centre - eye, plus the cone's) less
// the radius. What is not stitched to a node turned away (objects/border_stitcher.h) stays in its cone.
// Thread-safety: pure functions.
#pragma once

#include "libdb/access/database.h"

namespace deltaz {

// True only if no face of the node, at its level or any finer one, shows its front to the eye.
bool facesAway(const Node& node, const Vector3& eye);

}  // namespace deltaz
