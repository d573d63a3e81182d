// Where the vertices of a seam stand (formats/seam.md). Thread-safety: pure functions.
#pragma once

#include <array>
#include <cstdint>

#include "formats/seam.h"
#include "libdb/access/earth.h"

namespace deltaz {

inline std::uint16_t gridOf(const Seam& seam, SeamSide side) {
  return side == SeamSide::kUpper ? seam.upper : seam.lower;
}

// Earth-centred metres. `post_at(grid, column, row)` gives the position of a level-0 post; it is asked for no
// more posts than the vertex depends on.
template <typename PostAt>
Vector3 seamVertexPosition(const Seam& seam, const SeamVertex& vertex, const PostAt& post_at) {
  const std::uint16_t grid = gridOf(seam, vertex.side);
  const Vector3 p0 = post_at(grid, vertex.column, vertex.row);
  Vector3 position = p0;
  const auto lean = [&](const std::array<std::int8_t, 2>& step, double weight) {
    if (weight == 0) return;
    position = position + (post_at(grid, vertex.column + step[0], vertex.row + step[1]) - p0) * weight;
  };
  lean(vertex.to_p1, vertex.weight1);
  lean(vertex.to_p2, vertex.weight2);
  return position;
}

}  // namespace deltaz
