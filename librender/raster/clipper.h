// Cuts a triangle in view space by planes: the careful way for the few that reach before the hither plane or
// beyond the guard band.
//
// A new corner is always computed from the inside end of its edge towards the outside end, so that the two
// faces of an edge get the same point. Thread-safety: plain values.
#pragma once

#include <array>
#include <cstddef>
#include <span>

#include "libdb/access/vector3.h"

namespace deltaz {

// A corner with its barycentric weights (the first vertex has what is left to one).
struct ClipVertex {
  Vector3 position;  // (U, V, W)
  double weight1 = 0, weight2 = 0;
};

// Convex; five planes add at most one corner each.
class ClipPolygon {
 public:
  explicit ClipPolygon(const std::array<Vector3, 3>& corners);

  // Keeps what has dot(plane, position) >= offset.
  void clip(const Vector3& plane, double offset);
  void clipToHither();
  void clipToGuardBand();
  std::span<const ClipVertex> corners() const { return {corners_.data(), size_}; }

 private:
  std::array<ClipVertex, 8> corners_;
  std::size_t size_;
};

// True if all three corners lie beyond one of the planes that bound the picture or before the hither plane.
bool isOutsidePicture(const std::array<Vector3, 3>& corners, int width, int height);

}  // namespace deltaz
