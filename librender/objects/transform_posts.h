// Four ways from a tile's posts to view space, behind one interface, so that their run time and their error
// can be measured side by side (tests/bench/bench_transforms.cpp).
//
// exact   terrain_object_processor.h in double: the separable WGS-84 transform, or a projected grid's patches
// delta   the report's grid transform (5.5.2, Eq 1-5): the tile is a flat grid, the first post goes through
//         the whole matrix, each next one adds the axis and its delta-z times the vertical axis, three
//         multiplications and six additions a post, in single precision, so rounding accumulates
// matrix  the same flat grid, every post through a 4 x 4 matrix in single precision
// local   exact Earth-centred offsets from the tile's middle, rounded to single precision once per tile; the
//         view matrix is relative to the eye, its translation is rounded to single precision once per frame
//
// delta and matrix leave out the curvature of the Earth inside a tile (transform_planar.h). How far off each
// may be is proved by transform_error_bound.h. But for exact, a post that two tiles share comes out
// differently from each, and the sum of both bounds is how wide a crack may be there: with 64 cells of 3",
// latitude 45, seen from 1 km, 14 mm for local (0.4 mm are found), 4.6 m for delta and matrix (1 m). Both
// kinds of grid are served. All deliver doubles, so that one can take the other's place, with the same bits
// on every processor. Thread-safety: const members from any thread.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "formats/error.h"
#include "libdb/access/grid_geometry.h"
#include "libdb/access/terrain_tile.h"
#include "librender/objects/transform_planar.h"
#include "librender/objects/view_positions.h"
#include "librender/scene/camera.h"
#include "librender/scene/transform_kind.h"

namespace deltaz {

// A tile made ready for one of the transforms: what does not depend on the view is done once.
class TileTransform {
 public:
  // `tile` and `geometry` must outlive the result. Error: kInternal for a projected grid without its patches.
  static Result<TileTransform> make(TransformKind kind, const TerrainTile& tile,
                                    const GridGeometry& geometry);

  // (U, V, W) of every post, row by row, tile.columns * tile.rows of them; `out` is overwritten. What stands
  // at a void post is not used by any face.
  void apply(const ViewTransform& view, std::vector<Vector3>& out) const;
  // The same as lists, of as many posts at a time as the processor takes. Delta summation is serial along a
  // row, so there a lane is a row.
  void apply(const ViewTransform& view, ViewPositions& out) const;

  // What is kept from frame to frame, besides the tile.
  std::size_t storedBytes() const;

 private:
  TileTransform(TransformKind kind, const TerrainTile& tile, const GridGeometry& geometry)
      : kind_(kind), tile_(&tile), geometry_(&geometry) {}
  void prepareDeltas();
  void prepareHeights();
  void prepareOffsets();
  void applyDelta(const ViewTransform& view, ViewPositions& out) const;
  void applyMatrix(const ViewTransform& view, ViewPositions& out) const;
  void applyLocal(const ViewTransform& view, ViewPositions& out) const;

  TransformKind kind_;
  const TerrainTile* tile_;
  const GridGeometry* geometry_;
  PlanarGrid planar_;
  // delta: delta-z in metres, post (0, 0) above the base, column by column; matrix: height above the base in
  // metres, row by row.
  std::vector<float> heights_;
  std::array<std::vector<float>, 3> offsets_;  // local: Earth-centred x, y, z in metres from planar_.origin
};

// TileTransform::make and apply in one.
Result<std::vector<Vector3>> transformPosts(TransformKind kind, const TerrainTile& tile,
                                            const GridGeometry& geometry, const ViewTransform& view);

}  // namespace deltaz
