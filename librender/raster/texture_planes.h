// Where a sample of a face lies in its grid, and how far its neighbours on the screen are from it.
//
// Columns and rows divided by U are linear on the screen (report 6.4); with d = 1/U of the sample,
//   i_m = [i_m0 + i_mi (i - i0) + i_mj (j - j0)] / d + i_mh
// and its derivatives are  d(i_m)/di = [i_mi - (i_m - i_mh) d_i] / d,  and so on. Here i_mh, j_mh are the
// coordinates of the face's first vertex, so that what is divided is no larger than the face, and the
// constants come from differences of vertices. In double throughout. Thread-safety: pure functions.
#pragma once

#include "librender/raster/pretiler.h"

namespace deltaz {

struct TexturePlanes {
  GridCoordinates origin;   // i_mh, j_mh
  ScreenPlane column, row;  // what stands in brackets
};

TexturePlanes texturePlanes(const FacePlanes& face);

// What a sample shows of a grid.
struct TextureFootprint {
  GridCoordinates place;
  GridCoordinates per_j, per_i;  // its derivatives
  // The size of the pixel, level-0 cells: the larger of its two steps, along a row and along a column of the
  // picture, each as the Euclidean length of its change in columns and rows. Cells count as squares, as
  // texels do: a level has the same number of them along both sides of a cell.
  double size() const;
};

// `inverse_u` as of FacePlanes::inverseDepthAt(j, i). The place is kept within the face's columns and rows,
// so that samples of slivers, which may lie just outside the unsnapped triangle, cannot extrapolate.
TextureFootprint footprintAt(const FacePlanes& face, double j, double i, double inverse_u);

}  // namespace deltaz
