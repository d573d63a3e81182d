// How far two triangle meshes lie apart: the two-sided distance (Hausdorff), as a bound that is never too
// small.
//
// Branch and bound over the triangles of one mesh: where the distance at the corners is known, the distance
// to one and the same triangle of the other mesh at the corners bounds that of everything between, since the
// distance to a convex set is convex. Triangles that could still decide are cut along the edges of the other
// mesh, all of it that lies over them at once where it is whole there (mesh_overlay.h), until bound and
// largest distance found agree. Source: CGAL's AABB tree finds nearest triangles; what
// it answers decides speed and tightness alone, never that the bound holds. Thread-safety: const members from
// any thread.
#pragma once

#include <array>
#include <memory>

#include "libdb/access/vector3.h"
#include "libdb/build/triangle_view.h"

namespace deltaz {

// Of the triangle `corners`, the weights of its corners in the point nearest to p.
std::array<double, 3> nearestWeights(const std::array<Vector3, 3>& corners, const Vector3& p);

// Finds the triangle of a mesh that is nearest to a point. The view's memory must outlive it.
class NearestTriangle {
 public:
  explicit NearestTriangle(const TriangleView& mesh);
  ~NearestTriangle();
  NearestTriangle(const NearestTriangle&) = delete;
  NearestTriangle& operator=(const NearestTriangle&) = delete;

  const TriangleView& mesh() const { return mesh_; }
  std::size_t find(const Vector3& p) const;

 private:
  TriangleView mesh_;
  struct Tree;
  std::unique_ptr<Tree> tree_;
};

// The bound is within this part of the distance, or within `least`.
inline constexpr double kDistanceTightness = 0.05;

// Never less than the distance of any point of either mesh from the other. Pre: both have triangles.
double meshDistanceBound(const NearestTriangle& a, const NearestTriangle& b, double least);

}  // namespace deltaz
