// What the pretiler hands on: triangles on one machine's screen, with the planes of their values.
//
// i counts lines from the top, j pixels from the left; pixel centres are integers. Thread-safety: plain
// values.
#pragma once

#include <array>

#include "librender/ars/words/projected_triangle.h"

namespace deltaz::ars {

// Colours are red, green and blue, 0 to 255, as the frame memory shows them.
inline constexpr int kColors = 3;

// View space: u metres forward, v to the right and w down, both scaled to pixels, so that a point shows at
// column centre_j + v / u and line centre_i + w / u.
struct ViewVertex {
  double u = 0, v = 0, w = 0;
  std::array<double, kColors> color{};
};

struct ViewTriangle {
  std::array<ViewVertex, 3> vertex;
};

struct ScreenPosition {
  double i = 0, j = 0;
};

// What the pieces share that the screen's border cut a triangle into.
struct ScreenPlanes {
  ScreenPosition anchor;  // one of the triangle's own vertices, in front of the hither plane
  ScreenPlane inverse_u;
  std::array<ScreenPlane, kColors> color;              // linear on the screen, as the machine's is
  std::array<ScreenPlane, kColors> color_over_u;       // of colour linear in space, times 1/U
  double least_inverse_u = 0, greatest_inverse_u = 0;  // over what lies in front of the hither plane
};

struct ScreenTriangle {
  std::array<ScreenPosition, 3> corner;  // 0 <= i, j <= 511
  ScreenPlanes planes;
};

}  // namespace deltaz::ars
