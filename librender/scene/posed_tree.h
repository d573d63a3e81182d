// The tree of parts of a model as it stands in some pose: each part's matrix to model space, concatenated
// from the root down (motion, default transform, parent's; report 5.7), and spheres to skip parts and whole
// subtrees by.
//
// Errors: matrices that multiply to more than any model can be, or to nothing: kUsage if a pose is among
// them, else kInvalid with kModelTree. Thread-safety: plain values and pure functions.
#pragma once

#include <cstdint>
#include <vector>

#include "formats/error.h"
#include "formats/model_file.h"
#include "libdb/access/vector3.h"
#include "librender/scene/pose_table.h"

namespace deltaz {

// Metres; a negative radius holds nothing.
struct Sphere {
  Vector3 centre;
  double radius = -1;
  bool empty() const { return radius < 0; }
};

// Holds both.
Sphere enclosing(const Sphere& a, const Sphere& b);
// Holds the sphere once m is applied.
Sphere transformed(const Sphere& sphere, const ModelTransform& m);

// What of a part's matrix to model space is believed: entries and reach, metres, and the volume of what was a
// cubic metre.
inline constexpr double kLargestPosedMetres = 1e9;
inline constexpr double kSmallestPosedVolume = 1e-36;

struct PosedTree {
  std::vector<ModelTransform> to_model;  // of each part
  // In model space: what a part itself shows, and it with all that hangs under it. Empty where nothing is.
  std::vector<Sphere> own, subtree;
  std::vector<std::vector<std::uint32_t>> children;  // of each part, ascending
};

Result<PosedTree> posedTree(const ModelTree& tree, const PoseTable& poses, std::uint32_t model,
                            std::uint32_t variant);

}  // namespace deltaz
