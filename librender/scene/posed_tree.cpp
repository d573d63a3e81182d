#include "librender/scene/posed_tree.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <fmt/format.h>
#include <string>

#include "libdb/access/model.h"

namespace deltaz {
namespace {

// More than the rounding of the few operations that move a sphere.
constexpr double kRoundUp = 1 + 1e-12;

bool isBelievable(const ModelTransform& m) {
  for (const double value : m) {
    if (!(std::abs(value) <= kLargestPosedMetres)) return false;
  }
  const double volume = m[0] * (m[4] * m[8] - m[5] * m[7]) - m[1] * (m[3] * m[8] - m[5] * m[6]) +
                        m[2] * (m[3] * m[7] - m[4] * m[6]);
  return std::abs(volume) >= kSmallestPosedVolume;
}

}  // namespace

Sphere enclosing(const Sphere& a, const Sphere& b) {
  if (a.empty()) return b;
  if (b.empty()) return a;
  const double apart = length(b.centre - a.centre);
  if (apart + b.radius <= a.radius) return a;
  if (apart + a.radius <= b.radius) return b;
  const double radius = (apart + a.radius + b.radius) / 2;
  const Vector3 centre = a.centre + (b.centre - a.centre) * ((radius - a.radius) / apart);
  const double magnitude = std::abs(centre.x) + std::abs(centre.y) + std::abs(centre.z);
  return {centre, (radius + magnitude * 1e-15) * kRoundUp};
}

Sphere transformed(const Sphere& sphere, const ModelTransform& m) {
  if (sphere.empty()) return sphere;
  const Vector3 centre = transformPoint(m, sphere.centre);
  const double magnitude = std::abs(centre.x) + std::abs(centre.y) + std::abs(centre.z);
  return {centre, (sphere.radius * largestStretch(m) + magnitude * 1e-15) * kRoundUp};
}

Result<PosedTree> posedTree(const ModelTree& tree, const PoseTable& poses, std::uint32_t model,
                            std::uint32_t variant) {
  const std::size_t count = tree.parts.size();
  PosedTree posed;
  posed.children.resize(count);
  for (std::uint32_t p = 0; p < count; ++p) {
    const ModelPart& part = tree.parts[p];
    const ModelTransform* motion = poses.motion(model, variant, p);
    ModelTransform matrix = motion != nullptr ? concatenate(*motion, part.transform) : part.transform;
    if (part.parent != kNoParent) {
      matrix = concatenate(matrix, posed.to_model[part.parent]);
      posed.children[part.parent].push_back(p);
    }
    posed.to_model.push_back(matrix);
    Sphere own;
    if (!part.lods.empty())
      own = transformed({{part.centre[0], part.centre[1], part.centre[2]}, part.radius}, matrix);
    if (!isBelievable(matrix) || !(own.radius <= kLargestPosedMetres)) {
      const std::string where =
          fmt::format("model {} of area.json, counted from 0, part \"{}\"", model, part.name);
      const char* const what =
          "the matrices from it to its model's root multiply to nothing, or to more than any model";
      if (poses.posed(model, variant)) return usageError(where, what, "a pose is among them");
      return invalidError(IssueCode::kModelTree, where, what);
    }
    posed.own.push_back(own);
  }
  // Parents stand before their children.
  posed.subtree = posed.own;
  for (std::size_t p = count; p-- > 1;) {
    Sphere& parent = posed.subtree[tree.parts[p].parent];
    parent = enclosing(parent, posed.subtree[p]);
  }
  return posed;
}

}  // namespace deltaz
