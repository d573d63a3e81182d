// What the curved Earth hides: nothing is seen through the sea, which every engine draws (scene/sea.h), so
// what lies behind it needs neither reading nor drawing.
//
// A point is hidden if the segment from the eye to it crosses the sea's ellipsoid. Divided by the ellipsoid's
// semi-axes that is a unit sphere, and the hidden points behind it are those beyond the plane of the tangent
// points that lie inside the cone of tangents. Plane and cone are convex, so a box is hidden if its corners
// are. The test uses an ellipsoid a centimetre smaller than the sea's, so that what it hides is hidden
// whatever the rounding. Thread-safety: const members from any thread.
#pragma once

#include "formats/area.h"
#include "librender/scene/node_volume.h"

namespace deltaz {

class Horizon {
 public:
  Horizon(const AreaHeader& area, const Vector3& eye);

  // True only if the sea hides all of the volume. Never true if the eye is not above the sea.
  bool hides(const NodeVolume& volume) const;
  bool hides(const Vector3& point) const;

 private:
  Vector3 eye_;
  Vector3 inverse_axes_, scaled_eye_;
  double outside_ = -1;  // |scaled eye|^2 - 1
};

}  // namespace deltaz
