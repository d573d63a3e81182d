// A tile's posts in view space, as the lists a vector unit wants: all U, all V, all W.
//
// The exact transform of terrain_object_processor.h, on as many posts at a time as the processor takes
// (libdb/access/simd_target.h), with the same bits on every processor. Nothing is kept between frames but the
// constants of rows and columns; a list that was used before is filled without allocating. Source: report
// 5.5.2 and the separable transform of libdb/access/earth.h. Thread-safety: pure functions.
#pragma once

#include <cstddef>
#include <vector>

#include "libdb/access/grid_geometry.h"
#include "libdb/access/terrain_tile.h"
#include "libdb/access/tile_posts.h"
#include "libdb/access/vector3.h"
#include "librender/scene/camera.h"

namespace deltaz {

// Posts row by row from the south-west, one entry a post, then kPadding zeroes, so that a vector of up to
// that many doubles may be loaded from any post on.
struct ViewPositions {
  static constexpr std::size_t kPadding = kVectorPadding;

  std::vector<double> u, v, w;  // metres along the view axis; V and W in pixels per unit of tangent

  // Posts, without the padding.
  std::size_t count() const { return u.size() < kPadding ? 0 : u.size() - kPadding; }
  Vector3 at(std::size_t post) const { return {u[post], v[post], w[post]}; }
  // What stands there is undefined but for the padding.
  void resize(std::size_t posts);
};

// `positions` is overwritten. What stands at a void post is not used by any face. Cost: about a nanosecond a
// post of a geodetic grid, a few of a projected one.
void terrainViewPositions(const TilePosts& posts, const ViewTransform& view, ViewPositions& positions);
void terrainViewPositions(const TerrainTile& tile, const GridGeometry& geometry, const ViewTransform& view,
                          ViewPositions& positions);

}  // namespace deltaz
