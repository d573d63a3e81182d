// How far the facets of a coarser level lie from the full-resolution posts, along the ellipsoid normal.
//
// A facet is a triangle in space between three Earth-centred posts, SW-NE diagonal, exactly as it is drawn,
// so the sag of a chord under the curved Earth counts. At a post the full-resolution surface is the post
// itself; between_posts.h bounds what lies between.
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

}  // namespace deltaz
