#include "librender/reference/reference_models.h"

#include <GeographicLib/Geocentric.hpp>
#include <cmath>
#include <cstddef>
#include <fmt/format.h>
#include <map>
#include <numbers>
#include <utility>

namespace deltaz {
namespace {

template <typename T>
Vector3 toVector(const std::array<T, 3>& a) {
  return {static_cast<double>(a[0]), static_cast<double>(a[1]), static_cast<double>(a[2])};
}

// (p, w) M of the report: w = 1 for points, 0 for directions.
Vector3 applied(const ModelTransform& m, const Vector3& p, double w) {
  return Vector3{m[0], m[1], m[2]} * p.x + Vector3{m[3], m[4], m[5]} * p.y + Vector3{m[6], m[7], m[8]} * p.z +
         Vector3{m[9], m[10], m[11]} * w;
}

// Where a part of one placement stands.
class PlacedPart {
 public:
  PlacedPart(const ModelTree& tree, std::uint32_t part, const Placement& placement, const PoseTable& poses,
             const Environment& environment, const EllipsoidShape& ellipsoid)
      : anchor_(toVector(tree.anchor)) {
    for (std::uint32_t p = part; p != kNoParent; p = tree.parts[p].parent) {
      if (const ModelTransform* motion = poses.motion(placement.model, placement.instance, p))
        upwards_.push_back(*motion);
      upwards_.push_back(tree.parts[p].transform);
    }
    const GeographicLib::Geocentric earth(
        ellipsoid.semi_major_axis, ellipsoid.inverse_flattening == 0 ? 0 : 1 / ellipsoid.inverse_flattening);
    Vector3 at;
    std::vector<double> axes(9);  // rows of the matrix from (east, north, up) to Earth-centred axes
    earth.Forward(placement.latitude, placement.longitude, placement.height, at.x, at.y, at.z, axes);
    const Vector3 east{axes[0], axes[3], axes[6]}, north{axes[1], axes[4], axes[7]};
    up_ = {axes[2], axes[5], axes[8]};
    const double heading = placement.heading * (std::numbers::pi / 180);
    ahead_ = north * std::cos(heading) + east * std::sin(heading);
    right_ = east * std::cos(heading) + north * -std::sin(heading);
    from_eye_ = at - environment.view.eye;
    mirrored_ = dot(cross(direction({1, 0, 0}), direction({0, 1, 0})), direction({0, 0, 1})) < 0;
  }

  // Earth-centred axes, from the eye.
  Vector3 point(Vector3 p) const {
    for (const ModelTransform& m : upwards_) p = applied(m, p, 1);
    return from_eye_ + toEarth(p - anchor_);
  }
  // The unit normal that stands on a surface whose normal in the part's space is n.
  Vector3 normal(const Vector3& n) const {
    // Two directions in the surface stay in it.
    const bool along_x = std::abs(n.x) > std::abs(n.y);
    const Vector3 first = cross(n, along_x ? Vector3{0, 1, 0} : Vector3{1, 0, 0});
    const Vector3 second = cross(n, first);
    return normalized(cross(direction(first), direction(second))) * (mirrored_ ? -1 : 1);
  }
  bool mirrored() const { return mirrored_; }

 private:
  Vector3 direction(Vector3 d) const {
    for (const ModelTransform& m : upwards_) d = applied(m, d, 0);
    return toEarth(d);
  }
  Vector3 toEarth(const Vector3& p) const { return right_ * p.x + ahead_ * p.y + up_ * p.z; }

  std::vector<ModelTransform> upwards_;  // from the part to the root, in the order they are applied
  Vector3 anchor_, right_, ahead_, up_, from_eye_;
  bool mirrored_ = false;
};

// Matrices that multiply to infinity leave nothing to be drawn.
bool isPoint(const Vector3& p) {
  return length(p) < 1e12;
}

Status addMesh(const ModelMesh& mesh, const PlacedPart& part, std::uint32_t instance,
               const Environment& environment, FrameStatistics::Triangles& counts,
               std::vector<ReferenceModelTriangle>& triangles) {
  const ViewTransform& view = environment.view;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    ++counts.in;
    const auto& corners = mesh.triangles[t];
    std::array<Vector3, 3> at;
    for (std::size_t k = 0; k < 3; ++k) at[k] = part.point(toVector(mesh.vertices[corners[k]]));
    if (!isPoint(at[0]) || !isPoint(at[1]) || !isPoint(at[2])) {
      return invalidError(IssueCode::kModelTree, fmt::format("instance {}", instance),
                          "the matrices of one of its parts multiply to more than any model");
    }
    const Vector3 outwards = cross(at[1] - at[0], at[2] - at[0]) * (part.mirrored() ? -1 : 1);
    const double away = dot(outwards, at[0]);
    if (away == 0 || (away > 0 && !mesh.two_sided)) {
      ++counts.back_facing;
      continue;
    }
    const double side = away > 0 ? -1 : 1;
    ReferenceModelTriangle triangle;
    triangle.identity = std::uint64_t{instance} << 32 | t;
    for (std::size_t k = 0; k < 3; ++k) {
      triangle.position[k] = {dot(view.forward, at[k]), dot(view.right, at[k]) * view.pixels,
                              dot(view.down, at[k]) * view.pixels};
      const Vector3 normal =
          mesh.curveShaded() ? part.normal(toVector(mesh.normals[corners[k]])) : normalized(outwards);
      const auto& code = mesh.colors[mesh.colored_by_vertex ? corners[k] : t];
      triangle.color[k] = LinearColor{decodeSrgb(code[0]), decodeSrgb(code[1]), decodeSrgb(code[2])} *
                          environment.light.intensity(normal * side);
    }
    if ((side < 0) != part.mirrored()) {
      std::swap(triangle.position[1], triangle.position[2]);
      std::swap(triangle.color[1], triangle.color[2]);
    }
    triangles.push_back(triangle);
  }
  return Success{};
}

}  // namespace

Result<std::vector<ReferenceModelTriangle>> referenceModels(const Database& database, const PoseTable& poses,
                                                            const Environment& environment,
                                                            FrameStatistics& statistics) {
  std::vector<ReferenceModelTriangle> triangles;
  if (database.placements() == nullptr) return triangles;
  DELTAZ_TRY_ASSIGN(const std::vector<Placement> placements, database.placements()->all());
  std::map<std::pair<std::uint32_t, std::uint32_t>, ModelMesh> meshes;  // by model and part
  for (const Placement& placement : placements) {
    const Model& model = database.models()[placement.model];
    const ModelTree& tree = model.tree();
    for (std::uint32_t p = 0; p < tree.parts.size(); ++p) {
      if (tree.parts[p].lods.empty()) continue;
      auto mesh = meshes.find({placement.model, p});
      if (mesh == meshes.end()) {
        DELTAZ_TRY_ASSIGN(ModelMesh finest, model.mesh(tree.parts[p].lods.front()));
        mesh = meshes.emplace(std::pair(placement.model, p), std::move(finest)).first;
      }
      const PlacedPart part(tree, p, placement, poses, environment, database.area().grids.front().ellipsoid);
      DELTAZ_TRY(
          addMesh(mesh->second, part, placement.instance, environment, statistics.triangles, triangles));
    }
  }
  statistics.models.visited = statistics.models.drawn = placements.size();
  return triangles;
}

}  // namespace deltaz
