// How much of a pixel a polygon covers, weighted by a filter: the integral that samples estimate, by exact
// quadrature.
//
// Along a line of constant y a convex polygon covers one interval of x, over which a filter integrates in
// closed form; over y the result is smooth between the polygon's corners, the filter's knots and the places
// where an edge crosses a knot in x, and ten Gauss points a piece are exact for polynomials of degree 19.
// Thread-safety: pure functions.
#pragma once

#include <vector>

#include "librender/antialias/filter.h"

namespace deltaz {

struct ScreenPoint {
  double x = 0, y = 0;  // pixels; pixel centres at integers
};
using ConvexPolygon = std::vector<ScreenPoint>;

// Of pixel (j, i); 1 if the polygon covers all that the filter sees. Either orientation.
double analyticCoverage(const ConvexPolygon& polygon, FilterKind filter, int j, int i);

}  // namespace deltaz
