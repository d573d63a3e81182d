// From a projected triangle to what a tiler is given (report 5.2, 5.3, 7.2.2): vertices rounded to the vertex
// format and sorted on i, the corner, and planes of depth and colour anchored at the corner vertex and moved
// to its pixel.
//
// Gradients are vertex differences in double: the report's 3 x 3 system loses digits (7.2.2). Vertices are
// rounded for coverage only; planes belong to the vertices as they came. Every input is defined: coordinates
// are kept where their pixels are 0..511, a triangle without area has flat planes, and what is no number is
// 0. Thread-safety: reentrant.
#pragma once

#include "librender/ars/pretiler/screen_triangle.h"
#include "librender/ars/words/number_profile.h"
#include "librender/ars/words/projected_triangle.h"
#include "librender/ars/words/triangle_variables.h"

namespace deltaz::ars {

struct EncodeOptions {
  bool oversample = false;
  bool background = false;
};

// Planes of one triangle, which those it was clipped to share; anchored at (i, j).
struct TrianglePlanes {
  double i = 0, j = 0;
  ScreenPlane depth, color, color_over_depth;
};

// Anchored at vertex `anchor`, 0..2.
TrianglePlanes planesOf(const ProjectedTriangle& triangle, std::size_t anchor);

struct EncodedTriangle {
  TriangleVariables variables;  // tileable
  TriangleSupplement supplement;
};

EncodedTriangle encodeTriangle(const ProjectedTriangle& triangle, const NumberProfile& numbers,
                               const EncodeOptions& options);
// With the planes of the triangle that this one was clipped from: gradients are computed once.
EncodedTriangle encodeTriangle(const ProjectedTriangle& triangle, const TrianglePlanes& planes,
                               const NumberProfile& numbers, const EncodeOptions& options);

// The corners of a triangle that the pretiler hands on, with what its planes have there; `primary` is 0..2,
// red, green or blue.
ProjectedTriangle projectedCorners(const ScreenTriangle& triangle, int primary);
// Of such a triangle. The supplement's c/U is that of the corners, which is exact where the screen's border
// has not cut it.
EncodedTriangle encodeTriangle(const ScreenTriangle& triangle, int primary, const NumberProfile& numbers,
                               const EncodeOptions& options);

}  // namespace deltaz::ars
