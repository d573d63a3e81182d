// The levels of detail of one mesh: coarser and coarser versions with the colours and normals of the finest,
// each with its distance from the finest. Thread-safety: pure functions.
#pragma once

#include <vector>

#include "libdb/build/model_writer.h"
#include "libdb/source/mesh_source.h"

namespace deltaz {

// Each level has about half the triangles of the one before, until fewer than this are left.
inline constexpr std::size_t kCoarsestTriangles = 100;
// A level is left out if its error exceeds this part of the mesh's radius.
inline constexpr double kLargestErrorInRadii = 0.25;
// How loose a stored error may be where it is nearly nothing, in radii of the mesh.
inline constexpr double kDistanceSlackInRadii = 1e-5;

// Finest first, `levels` at most; a coarser one has fewer triangles and a larger error. Pre: as repairMesh
// leaves it, with a triangle.
std::vector<FinishedLod> makeDetailLevels(const ImportedMesh& mesh, std::size_t levels);

}  // namespace deltaz
