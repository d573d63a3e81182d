// The model object processor (report 5.4, Table 13): one part of a placed model, lit and coloured, in view
// space.
//
// Eye and sun are brought into the part's own space; faces are tested and lit there, and each vertex goes
// through the matrices once. A face turned away from the eye is dropped unless the mesh is two-sided; then
// its normals are turned to the eye. The intensity is that of Light, S.N being the cosine to the normal as
// the matrix places it: S.N of the part's own space for rotations and equal scales, and right for any other
// matrix. Curve-shaded meshes are lit per vertex, others per face. A scene definition in this: what a
// two-sided mesh and its light mean is the same for every engine. Thread-safety: pure functions.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "formats/model_file.h"
#include "libdb/access/color.h"
#include "libdb/access/vector3.h"
#include "librender/scene/camera.h"
#include "librender/scene/illumination.h"

namespace deltaz {

struct ModelFace {
  std::array<std::uint32_t, 3> vertex{};  // counter-clockwise seen from the eye
  std::array<LinearColor, 3> color;       // of each corner, lit, linear
  std::uint32_t identity = 0;             // number of the triangle in its mesh
};

struct ModelFaces {
  std::vector<Vector3> position;  // (U, V, W) of the mesh's vertices
  std::vector<ModelFace> front;
  std::uint64_t in = 0, back_facing = 0;  // in = back_facing + front.size()
};

// Part's space -> view space, of a matrix part's space -> Earth-centred metres. Its translation is taken
// relative to the eye first, so that what is near the eye loses nothing.
ModelTransform viewTransformOf(const ModelTransform& to_earth, const ViewTransform& view);

// Pre: `to_earth` keeps three dimensions.
ModelFaces modelFaces(const ModelMesh& mesh, const ModelTransform& to_earth, const ViewTransform& view,
                      const Light& light);

}  // namespace deltaz
