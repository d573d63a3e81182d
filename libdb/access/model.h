// A model of a database: its tree of parts, and their meshes on demand; and where a placement puts it.
//
// Errors: whatever reading reports. Thread-safety: const members from any thread.
#pragma once

#include <memory>

#include "formats/area.h"
#include "formats/container.h"
#include "formats/model_file.h"
#include "formats/placement_file.h"
#include "libdb/access/earth.h"
#include "libdb/access/vector3.h"

namespace deltaz {

class Model {
 public:
  static Result<Model> open(std::unique_ptr<ContainerReader> file);

  const ModelTree& tree() const { return tree_; }
  // kModelMesh if the mesh has not the triangles its level of detail announces.
  Result<ModelMesh> mesh(const ModelLod& lod) const;
  const ContainerReader& file() const { return *file_; }

 private:
  Model() = default;
  std::unique_ptr<ContainerReader> file_;
  ModelTree tree_;
};

// Where models stand; pages are read on demand.
class PlacementSet {
 public:
  static Result<PlacementSet> open(std::unique_ptr<ContainerReader> file, std::size_t models);

  const PlacementDirectory& directory() const { return directory_; }
  Result<std::vector<Placement>> page(std::uint32_t number) const;
  // All of them, in the order of the pages.
  Result<std::vector<Placement>> all() const;
  const ContainerReader& file() const { return *file_; }

 private:
  PlacementSet() = default;
  std::unique_ptr<ContainerReader> file_;
  std::size_t models_ = 0;
  PlacementDirectory directory_;
};

// p as the row vector (x, y, z, 1) times m.
Vector3 transformPoint(const ModelTransform& m, const Vector3& p);
// First a, then b.
ModelTransform concatenate(const ModelTransform& a, const ModelTransform& b);
// How much m stretches lengths at most (its largest singular value).
double largestStretch(const ModelTransform& m);

// Model space -> Earth-centred metres: the anchor at the placement's position, y towards its heading, z along
// the ellipsoid normal.
ModelTransform placementTransform(const Placement& placement, const std::array<double, 3>& anchor,
                                  const EllipsoidShape& ellipsoid);

}  // namespace deltaz
