// Coarser versions of a triangle mesh, by collapsing edges where the least is lost (quadric errors), through
// OpenMesh. Open borders and triangles turning over are guarded. Vertices of a coarser mesh are vertices of
// the finest. Thread-safety: pure functions; the result is the same on every run.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "libdb/build/mesh_distance.h"

namespace deltaz {

struct DecimatedMesh {
  std::vector<std::array<std::uint32_t, 3>> triangles;  // of the finest mesh's vertices
};

// One mesh for each of `targets`, numbers of triangles in falling order; each has at most about as many,
// unless no edge is left that may be collapsed. Edges of more than two triangles are kept as borders of
// separate fans.
std::vector<DecimatedMesh> decimateMesh(const TriangleView& mesh, std::span<const std::size_t> targets);

}  // namespace deltaz
