// Turns triangles with normals and colours at their corners into the most compact form of Table 12 that loses
// nothing: face-shaded where the normals are those of the triangles, colours per triangle or per vertex,
// whichever takes fewer bytes. Thread-safety: pure functions.
#pragma once

#include "formats/model_file.h"
#include "libdb/source/mesh_source.h"

namespace deltaz {

// Normals of a file that lie within this of their triangle's are the triangle's.
inline constexpr double kFlatNormalDegrees = 1;

// Pre: as repairMesh leaves it, with a triangle.
ModelMesh packMesh(const ImportedMesh& mesh);

}  // namespace deltaz
