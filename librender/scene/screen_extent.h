// What part of the picture a node can cover, and how near it can be: what an occlusion test needs to know
// before the node is read. A node is hidden if all samples within its extent already show something with a
// larger 1/U. Thread-safety: pure function.
#pragma once

#include "librender/scene/camera.h"
#include "librender/scene/node_volume.h"

namespace deltaz {

// Inclusive ranges of pixels inside the picture; empty (first > last) if the volume is beside it.
struct ScreenExtent {
  int first_j = 0, last_j = -1, first_i = 0, last_i = -1;
  // 1/U of no point of the volume beyond the hither plane is larger. Metres^-1.
  double largest_inverse_u = 0;

  bool empty() const { return first_j > last_j || first_i > last_i; }
};

// Holds every pixel whose square a point of the volume, moved by up to `margin` pixels on the screen, falls
// into. A volume that reaches the hither plane has all of the picture.
ScreenExtent screenExtent(const ViewTransform& view, const NodeVolume& volume, double margin = 0);

}  // namespace deltaz
