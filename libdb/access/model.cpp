#include "libdb/access/model.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <numbers>

namespace deltaz {

Result<Model> Model::open(std::unique_ptr<ContainerReader> file) {
  if (file->blockCount() == 0)
    return invalidError(IssueCode::kModelTree, file->path(), "the model has no tree of parts");
  const std::uint32_t last = file->blockCount() - 1;
  DELTAZ_TRY_ASSIGN(const std::vector<std::byte> bytes, file->read(last, BlockType::kModelTree));
  Model model;
  DELTAZ_TRY_ASSIGN(model.tree_, decodeModelTree(bytes, file->blockCount(),
                                                 fmt::format("{}, block {}", file->path(), last)));
  model.file_ = std::move(file);
  return model;
}

Result<ModelMesh> Model::mesh(const ModelLod& lod) const {
  const std::string where = fmt::format("{}, block {}", file_->path(), lod.block);
  DELTAZ_TRY_ASSIGN(const std::vector<std::byte> bytes, file_->read(lod.block, BlockType::kModelMesh));
  DELTAZ_TRY_ASSIGN(ModelMesh mesh, decodeModelMesh(bytes, where));
  if (mesh.triangles.size() != lod.triangle_count) {
    return invalidError(IssueCode::kModelMesh, where,
                        fmt::format("the mesh has {} triangles, not the {} its part announces",
                                    mesh.triangles.size(), lod.triangle_count));
  }
  return mesh;
}

Result<PlacementSet> PlacementSet::open(std::unique_ptr<ContainerReader> file, std::size_t models) {
  if (file->blockCount() == 0)
    return invalidError(IssueCode::kPlacementRecord, file->path(), "the placements have no directory");
  const std::uint32_t last = file->blockCount() - 1;
  DELTAZ_TRY_ASSIGN(const std::vector<std::byte> bytes, file->read(last, BlockType::kPlacementDirectory));
  PlacementSet set;
  DELTAZ_TRY_ASSIGN(
      set.directory_,
      decodePlacementDirectory(bytes, file->blockCount(), fmt::format("{}, block {}", file->path(), last)));
  set.models_ = models;
  set.file_ = std::move(file);
  return set;
}

Result<std::vector<Placement>> PlacementSet::page(std::uint32_t number) const {
  const std::string where = fmt::format("{}, block {}", file_->path(), number);
  DELTAZ_TRY_ASSIGN(const std::vector<std::byte> bytes, file_->read(number, BlockType::kPlacementPage));
  DELTAZ_TRY_ASSIGN(std::vector<Placement> placements, decodePlacementPage(bytes, models_, where));
  const std::size_t expected =
      std::min<std::size_t>(kPlacementsPerPage, directory_.count - std::size_t{number} * kPlacementsPerPage);
  if (placements.size() != expected) {
    return invalidError(IssueCode::kPlacementRecord, where,
                        fmt::format("the page has {} placements, not {}", placements.size(), expected));
  }
  for (const Placement& placement : placements) {
    if (placement.instance < directory_.next_instance) continue;
    return invalidError(IssueCode::kPlacementRecord, where,
                        fmt::format("instance {} has a number not yet given", placement.instance));
  }
  return placements;
}

Result<std::vector<Placement>> PlacementSet::all() const {
  std::vector<Placement> placements;
  for (std::uint32_t number = 0; number < directory_.pages.size(); ++number) {
    DELTAZ_TRY_ASSIGN(const std::vector<Placement> on_page, page(number));
    placements.insert(placements.end(), on_page.begin(), on_page.end());
  }
  return placements;
}

Vector3 transformPoint(const ModelTransform& m, const Vector3& p) {
  return {p.x * m[0] + p.y * m[3] + p.z * m[6] + m[9], p.x * m[1] + p.y * m[4] + p.z * m[7] + m[10],
          p.x * m[2] + p.y * m[5] + p.z * m[8] + m[11]};
}

ModelTransform concatenate(const ModelTransform& a, const ModelTransform& b) {
  ModelTransform m{};
  for (std::size_t row = 0; row < 4; ++row) {
    for (std::size_t column = 0; column < 3; ++column) {
      double sum = row == 3 ? b[9 + column] : 0;
      for (std::size_t k = 0; k < 3; ++k) sum += a[3 * row + k] * b[3 * k + column];
      m[3 * row + column] = sum;
    }
  }
  return m;
}

double largestStretch(const ModelTransform& m) {
  // The largest eigenvalue of the symmetric product of the linear part with its transpose, in closed form.
  double s[3][3];
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      s[i][j] = 0;
      for (std::size_t k = 0; k < 3; ++k) s[i][j] += m[3 * i + k] * m[3 * j + k];
    }
  }
  const double mean = (s[0][0] + s[1][1] + s[2][2]) / 3;
  const double off = s[0][1] * s[0][1] + s[0][2] * s[0][2] + s[1][2] * s[1][2];
  const double a = s[0][0] - mean, b = s[1][1] - mean, c = s[2][2] - mean;
  const double p = std::sqrt((a * a + b * b + c * c + 2 * off) / 6);
  // Sum of rounding errors that could make a rotation's stretch come out below one.
  constexpr double kRoundUp = 1 + 1e-12;
  if (!(p > 1e-12 * mean)) return std::sqrt(mean) * kRoundUp;
  const double determinant = (a * (b * c - s[1][2] * s[1][2]) - s[0][1] * (s[0][1] * c - s[1][2] * s[0][2]) +
                              s[0][2] * (s[0][1] * s[1][2] - b * s[0][2])) /
                             (2 * p * p * p);
  const double angle = std::acos(std::clamp(determinant, -1.0, 1.0)) / 3;
  return std::sqrt(mean + 2 * p * std::cos(angle)) * kRoundUp;
}

ModelTransform placementTransform(const Placement& placement, const std::array<double, 3>& anchor,
                                  const EllipsoidShape& ellipsoid) {
  const GeodeticPoint position{placement.latitude, placement.longitude, placement.height};
  const Vector3 at = toEarthCentred(ellipsoid, position);
  const double degree = std::numbers::pi / 180;
  const double latitude = placement.latitude * degree, longitude = placement.longitude * degree;
  const double heading = placement.heading * degree;
  const Vector3 east{-std::sin(longitude), std::cos(longitude), 0};
  const Vector3 north{-std::sin(latitude) * std::cos(longitude), -std::sin(latitude) * std::sin(longitude),
                      std::cos(latitude)};
  const Vector3 up{std::cos(latitude) * std::cos(longitude), std::cos(latitude) * std::sin(longitude),
                   std::sin(latitude)};
  const Vector3 right = east * std::cos(heading) + north * -std::sin(heading);
  const Vector3 ahead = east * std::sin(heading) + north * std::cos(heading);
  const ModelTransform to_earth = {right.x, right.y, right.z, ahead.x, ahead.y, ahead.z,
                                   up.x,    up.y,    up.z,    at.x,    at.y,    at.z};
  const ModelTransform to_anchor = {1, 0, 0, 0, 1, 0, 0, 0, 1, -anchor[0], -anchor[1], -anchor[2]};
  return concatenate(to_anchor, to_earth);
}

}  // namespace deltaz
