// What the readers of mesh_source.h share: the tree of a file as it stands there, before units, axes and
// frames are put right. Thread-safety: pure functions.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "libdb/source/mesh_source.h"

namespace deltaz {

struct RawMesh {
  std::vector<std::array<double, 3>> positions;
  std::vector<std::array<std::uint32_t, 3>> triangles;        // indices not yet checked
  std::vector<std::array<std::array<double, 3>, 3>> normals;  // at the corners, any length; or none
  std::vector<std::array<SrgbColor, 3>> colors;               // at the corners; or none
  bool two_sided = false;
};

struct RawNode {
  std::string name;
  std::uint32_t parent = kNoParent;               // an earlier node; kNoParent: of the file
  ModelTransform transform = kIdentityTransform;  // to the parent's space
  std::vector<RawMesh> meshes;
};

struct RawScene {
  std::vector<RawNode> nodes;
  std::vector<std::string> warnings;
};

// PLY, STL and OFF. `bytes` are the file's.
Result<RawScene> readWithOpenMesh(const std::string& path, const std::vector<std::byte>& bytes);
// OBJ and glTF/GLB. `bytes` are the file's.
Result<RawScene> readWithAssimp(const std::string& path, const std::vector<std::byte>& bytes);

}  // namespace deltaz
