// Pictures of white polygons on black that are hard to draw without jagged edges, as the rasteriser draws
// them with some sampling and as exact integrals say they should be.
//
// Errors are root mean squares over the pixels that lie far enough from the pictures' borders for every
// filter, of the white, in linear light. Thread-safety: pure functions.
#pragma once

#include <string>
#include <vector>

#include "tests/librender/antialias/analytic_coverage.h"

namespace deltaz {

inline constexpr int kScenePixels = 48;  // a side
inline constexpr int kSceneBorder = 3;   // pixels that are not judged

// Polygons do not overlap.
struct EdgeScene {
  std::vector<ConvexPolygon> polygons;
};
struct EdgeScenes {
  std::string name;
  std::vector<EdgeScene> scenes;
};

// Half planes at slopes all round; wires 0.4 pixel wide; a checkered ground up to its horizon; a fan of
// wedges, finer and finer towards its centre.
std::vector<EdgeScenes> edgeScenes();
// The same wire in places one after the other.
EdgeScenes movingWire();

// A value for each pixel, row by row; what polygons reach beyond the picture counts as well.
std::vector<double> drawnCoverage(const EdgeScene& scene, const Sampling& sampling);
std::vector<double> exactCoverage(const EdgeScene& scene, FilterKind filter);

// Of two pictures of a scene, over the pixels that are judged: the mean square of their difference, and the
// sum of one.
double meanSquare(const std::vector<double>& a, const std::vector<double>& b);
double sumOf(const std::vector<double>& picture);

}  // namespace deltaz
