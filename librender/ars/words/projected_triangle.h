// A triangle as the pretiler hands it over: on the screen, not yet in the machine's numbers.
// Screen i counts lines downwards, j pixels to the right, from the middle of the upper left pixel of the
// picture or sub-image. Depth is 1/U.
#pragma once

#include <array>

namespace deltaz::ars {

struct ProjectedVertex {
  double i = 0, j = 0;
  double depth = 0;  // 1/U, linear on the screen, larger is nearer
  double color = 0;  // 0..255, one primary

  bool operator==(const ProjectedVertex&) const = default;
};

using ProjectedTriangle = std::array<ProjectedVertex, 3>;

// A value that is linear on the screen: at an anchor, and its gradient.
struct ScreenPlane {
  double value = 0, per_i = 0, per_j = 0;
  double at(double di, double dj) const { return value + (per_i * di + per_j * dj); }
};

}  // namespace deltaz::ars
