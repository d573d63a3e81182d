// The part of space a picture shows: in front of the hither plane and inside the four planes through the eye
// and the picture's borders (half a pixel beyond the outermost pixel centres). Thread-safety: const members
// from any thread.
#pragma once

#include <array>

#include "librender/scene/camera.h"
#include "librender/scene/node_volume.h"

namespace deltaz {

// The hither plane, metres in front of the eye. The nearest ground of an eye-level view (1.7 m above ground)
// is more than ten times as far; nothing can be seen nearer unless the eye is on or in the ground.
inline constexpr double kHither = 0.1;

class ViewVolume {
 public:
  // Widened by `margin` pixels on each side of the picture.
  explicit ViewVolume(const ViewTransform& view, double margin = 0);

  // True only if nothing inside the sphere (Earth-centred, metres) can be in the picture.
  bool isOutside(const Vector3& centre, double radius) const;
  // The same of a node's volume.
  bool isOutside(const NodeVolume& volume) const;

 private:
  struct HalfSpace {
    Vector3 inward;       // unit vector
    double distance = 0;  // inside: dot(inward, p - eye) >= distance
  };
  Vector3 eye_;
  std::array<HalfSpace, 5> half_spaces_;
};

// Square of the largest tangent of the angle between the view axis and a ray of the picture.
double largestTangentSquared(const ViewTransform& view);

}  // namespace deltaz
