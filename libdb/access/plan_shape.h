// The plan of a grid: how large its cells are on the ellipsoid and how far its lines bow from the chords
// drawn between their posts. Thread-safety: pure functions and const members.
#pragma once

#include "libdb/access/grid_geometry.h"

namespace deltaz {

// Metres on the ellipsoid a step of one post eastwards and northwards stands for, at most: the plan distance
// of two places that lie u columns and v rows apart is no more than hypot(u * width, v * height).
struct CellSize {
  double width = 0, height = 0;
  double diagonal() const;
};

// The largest level-0 cell among these level-0 posts (at least two a side, inside the area). On a geodetic
// grid from the radii of curvature; on a projected one from up to 17 x 17 sampled posts, the largest
// difference between neighbouring samples added for what lies between them, and widened where the axes do not
// cross at right angles.
CellSize largestCell(const GridGeometry& geometry, PostRange columns, PostRange rows);

// How far, in metres, a straight edge of a coarser level may lie in plan beside the line of level-0 posts
// between its ends.
//
// Geodetic grids: from the geodesic equation, to second order, with a quarter more for what follows,
//   w = 1.25 (R / 8) sin|lat| dlon sqrt((cos(lat) dlon)^2 + 4 dlat^2),  dlon, dlat the coarse cell in
//   radians.
// Projected grids: a line with sideways acceleration a per post squared bows by a s^2 / 8 over s posts. The
// largest a of columns, rows and diagonals is measured by second differences over the area, the largest
// change of it between samples is added (third differences), and a quarter more for what follows; and twice
// the error of the control points, which displaces posts singly.
class SidewaysBow {
 public:
  // `geometry` must outlive it. On a projected grid this samples the area, about 65 x 65 posts.
  explicit SidewaysBow(const GridGeometry& geometry);

  // Of edges of level `level` >= 1 among these level-0 rows; on a projected grid, anywhere in the area.
  double at(int level, PostRange rows) const;

 private:
  const GridGeometry& geometry_;
  double of_one_post_ = 0;  // projected grids: metres an edge of one post would bow
  double of_patches_ = 0;
};

// Whether a facet covers ground: false where its posts' feet stand on one line, as two posts on a pole make
// them. Such a facet is a wall; no place lies under it, and its slope means nothing.
bool coversGround(const Vector3& foot_a, const Vector3& foot_b, const Vector3& foot_c);

// Chord sag in metres, at most, of a facet of level `level` whose posts lie up to `highest` metres high: how
// far its middle lies below the surface of that height.
double chordSag(const GridGeometry& geometry, int level, double highest);

}  // namespace deltaz
