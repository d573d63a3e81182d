// Model files, one per model: a tree of parts, each with a default transform and its meshes at several levels
// of detail. Specified in model_file.md.
//
// Model space: metres, right-handed, x to the right (east at heading 0), y ahead (north at heading 0), z up.
// Transforms are the report's 4 x 3 matrices for row vectors, (x, y, z, 1) M: three rows of the linear part,
// then the translation; a part's leads from its own space to its parent's.
//
// Source: report 5.4 (model data, Table 12 forms), 5.7 (trees). Errors: kInvalid with kModelTree or
// kModelMesh. Thread-safety: plain values and pure functions.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "formats/error.h"

namespace deltaz {

inline constexpr std::uint32_t kMaximumModelParts = 1u << 16;
inline constexpr std::uint32_t kMaximumPartLods = 16;
inline constexpr std::uint32_t kNoParent = 0xFFFFFFFF;
inline constexpr double kMaximumModelMetres = 1e6;  // coordinates, translations and radii stay within
inline constexpr double kModelNormalScale = 32767;

// One part at one level of detail, in the form of Table 12 its members say: with normals it is curve-shaded
// (C), without face-shaded (F); colours are one per vertex (V) or one per triangle (P). Triangles are
// counter-clockwise seen from outside.
struct ModelMesh {
  bool colored_by_vertex = false;
  bool two_sided = false;  // both sides of a triangle are seen
  std::vector<std::array<std::uint32_t, 3>> triangles;
  std::vector<std::array<float, 3>> vertices;        // metres, in the part's space
  std::vector<std::array<std::int16_t, 3>> normals;  // one per vertex, times kModelNormalScale; or none
  std::vector<std::array<std::uint8_t, 3>> colors;   // sRGB codes, one per vertex or one per triangle
  bool curveShaded() const { return !normals.empty(); }
  bool operator==(const ModelMesh&) const = default;
};

struct ModelLod {
  std::uint32_t block = 0;
  std::uint32_t triangle_count = 0;
  // Metres in the part's space, never too small: the two-sided distance (Hausdorff) between this mesh and the
  // finest.
  float error = 0;
  bool operator==(const ModelLod&) const = default;
};

using ModelTransform = std::array<double, 12>;
inline constexpr ModelTransform kIdentityTransform = {1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0};

struct ModelPart {
  std::string name;  // unique in its model, valid UTF-8 without control characters, 1 to 255 bytes
  std::uint32_t parent = kNoParent;  // number of an earlier part; kNoParent for part 0 alone
  ModelTransform transform = kIdentityTransform;
  std::array<double, 3> centre{};  // of a sphere, in the part's space, that holds its own meshes
  double radius = 0;
  std::vector<ModelLod> lods;  // finest first; none for a part that only carries others
  bool operator==(const ModelPart&) const = default;
};

// The last block of a model file; meshes come before it.
struct ModelTree {
  std::vector<ModelPart> parts;  // part 0 is the root; its space is the model's once its transform is applied
  // The point of model space that a placement puts at its position.
  std::array<double, 3> anchor{};
  // A sphere in model space that holds all parts as they stand by default.
  std::array<double, 3> centre{};
  double radius = 0;
  bool operator==(const ModelTree&) const = default;
};

std::vector<std::byte> encodeModelTree(const ModelTree& tree);
// `blocks`: blocks of the file, the tree's own included. Parents, counts, names and ranges are checked.
Result<ModelTree> decodeModelTree(std::span<const std::byte> bytes, std::uint32_t blocks,
                                  const std::string& where);

std::vector<std::byte> encodeModelMesh(const ModelMesh& mesh);
// Counts are checked against the length before anything is allocated, and every index against the vertices.
Result<ModelMesh> decodeModelMesh(std::span<const std::byte> bytes, const std::string& where);

// The bytes of a vertex and of a triangle in a mesh's form (Table 12): 12, 15, 18 or 21, and 12 or 15.
std::size_t vertexBytes(const ModelMesh& mesh);
std::size_t triangleBytes(const ModelMesh& mesh);

}  // namespace deltaz
