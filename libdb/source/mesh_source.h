// Reads meshes of other programs into one neutral form: a tree of parts in metres, z up, each a list of
// triangles with what the file says about normals and colours at their corners.
//
// Read are OBJ (with its materials) and glTF/GLB (nodes, materials, vertex colours, textures) through assimp,
// PLY, STL and OFF through OpenMesh. What a file holds beyond that (skins, animations, transparency, lines)
// is left out with a warning.
//
// Errors: kCannotAccess if the file cannot be read; kInvalid if it is none of these, is damaged, or its
// coordinates are no numbers or lie beyond kMaximumModelMetres. Thread-safety: pure functions.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "formats/error.h"
#include "formats/hash.h"
#include "formats/model_file.h"

namespace deltaz {

using SrgbColor = std::array<std::uint8_t, 3>;
// Where a file says nothing of colours.
inline constexpr SrgbColor kPlainMeshColor = {180, 180, 180};

struct ImportedMesh {
  std::vector<std::array<float, 3>> positions;  // metres in the part's space
  std::vector<std::array<std::uint32_t, 3>> triangles;
  // At the corners of each triangle. Normals are of length one, or there are none.
  std::vector<std::array<std::array<float, 3>, 3>> normals;
  std::vector<std::array<SrgbColor, 3>> colors;
  bool two_sided = false;
  bool operator==(const ImportedMesh&) const = default;
};

struct ImportedPart {
  std::string name;
  std::uint32_t parent = kNoParent;  // an earlier part
  // A rotation and a translation: scales and mirrorings of a file's nodes are worked into the positions, so
  // that every part's space is in metres and its lighting right.
  ModelTransform transform = kIdentityTransform;
  ImportedMesh mesh;  // empty for a part that only carries others
};

struct ImportedModel {
  std::vector<ImportedPart> parts;  // part 0 carries the others; names are not yet unique
  std::vector<std::string> warnings;
  Hash128 content;  // of the file's bytes
};

enum class UpAxis : std::uint8_t { kOfFormat, kY, kZ };  // kOfFormat: y for glTF, z for all others

struct MeshSourceOptions {
  double unit_metres = 1;  // length of the file's unit
  // With y up, the file's (x, y, z) becomes (x, -z, y).
  UpAxis up = UpAxis::kOfFormat;
};

Result<ImportedModel> readMeshSource(const std::string& path, const MeshSourceOptions& options);

}  // namespace deltaz
