// How far the facets of a coarser level lie from the full-resolution posts, along the ellipsoid normal.
//
// A facet is a triangle in space between three Earth-centred posts, SW-NE diagonal, exactly as it is drawn,
// so the sag of a chord under the curved Earth counts. At a post the full-resolution surface is the post
// itself.
//
// Between posts. Over a fine facet, the height of a plane above the ellipsoid along a plan line of slope g
// has the second derivative (1 + 2 g^2) / R (a plane over a sphere in polar form: r = d / cos(t)), so the
// difference of two planes stays within (1 + 2 g^2) d^2 / (8 R) of the interpolation between the posts, d the
// fine cell's diagonal. And a coarse edge, a chord in space, bows sideways in plan by w from the line of
// posts under it: where a fine facet lies across it, the coarse surface departs from the plane beside it by
// at most the change of slope times w. Hence the slack
//   (1 + 2 g0^2) d^2 / (8 R) + 4 gk w,
// g0 and gk the steepest facets of levels 0 and k, w the sidewaysBow of plan_shape.h.
#pragma once

#include <vector>

#include "formats/terrain_segment.h"
#include "libdb/access/grid_geometry.h"
#include "libdb/source/elevation_source.h"

namespace deltaz {

// Errors of level 1, 2, ... level_count - 1 over the posts of leaf (x, y). The maximum is over all posts of
// the leaf, its borders included; sum and count leave out the eastern and northern border, which the
// neighbours count, except at the area's end. Posts without a coarse facet over them (voids, an area's edge)
// are not compared.
std::vector<AncestorError> leafErrors(const RawGrid& grid, const GridGeometry& geometry, int level_count,
                                      std::int32_t x, std::int32_t y);

// The slack above, in metres, for level `level` >= 1. `steepest` holds the steepest facet's slope of each
// level. The same for all nodes of a level; on a projected grid it samples the area.
double betweenPostsSlack(const GridGeometry& geometry, int level, const std::vector<double>& steepest);

}  // namespace deltaz
