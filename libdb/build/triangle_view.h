// Triangles by their corners, as the measures of meshes take them.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "libdb/access/vector3.h"

namespace deltaz {

// None of the triangles is without an area.
struct TriangleView {
  std::span<const Vector3> positions;
  std::span<const std::array<std::uint32_t, 3>> triangles;
  std::array<Vector3, 3> corners(std::size_t t) const {
    return {positions[triangles[t][0]], positions[triangles[t][1]], positions[triangles[t][2]]};
  }
};

}  // namespace deltaz
