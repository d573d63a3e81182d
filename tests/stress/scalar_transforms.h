// The transforms of librender/objects/transform_posts.h post by post, as they are defined: what the vector
// code must give bit for bit, and what it is timed against.
#pragma once

#include <array>
#include <vector>

#include "librender/objects/transform_posts.h"

namespace deltaz {

class ScalarTransform {
 public:
  // `tile` and `geometry` must outlive the result. Pre: the tile has posts, a projected grid its patches.
  ScalarTransform(TransformKind kind, const TerrainTile& tile, const GridGeometry& geometry);

  // (U, V, W) of every post, row by row; `out` is overwritten.
  void apply(const ViewTransform& view, std::vector<Vector3>& out) const;

 private:
  void applyExact(const ViewTransform& view, std::vector<Vector3>& out) const;
  void applyDelta(const ViewTransform& view, std::vector<Vector3>& out) const;
  void applyMatrix(const ViewTransform& view, std::vector<Vector3>& out) const;
  void applyLocal(const ViewTransform& view, std::vector<Vector3>& out) const;

  TransformKind kind_;
  const TerrainTile* tile_;
  const GridGeometry* geometry_;
  PlanarGrid planar_;
  std::vector<float> heights_;                 // delta: delta-z; matrix: above the base
  std::vector<std::array<float, 3>> offsets_;  // local
};

}  // namespace deltaz
