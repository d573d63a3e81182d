#include "libdb/build/mesh_decimation.h"

// In this order: the header of quadrics does not include what it needs.
// clang-format off
#include <OpenMesh/Core/Utils/vector_traits.hh>
#include <OpenMesh/Core/Geometry/QuadricT.hh>
// clang-format on
#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>
#include <OpenMesh/Core/System/omstream.hh>
#include <OpenMesh/Tools/Decimater/DecimaterT.hh>
#include <OpenMesh/Tools/Decimater/ModBaseT.hh>
#include <algorithm>
#include <cmath>
#include <iostream>
#include <limits>

namespace deltaz {

namespace {

struct MeshTraits : public OpenMesh::DefaultTraits {
  using Point = OpenMesh::Vec3d;
  using Normal = OpenMesh::Vec3d;
};
using HalfedgeMesh = OpenMesh::TriMesh_ArrayKernelT<MeshTraits>;
using Quadric = OpenMesh::Geometry::Quadricd;
using Point = HalfedgeMesh::Point;

// How much a border resists being moved sideways, against the faces beside it.
constexpr double kBorderWeight = 10;
// Least cosine between a triangle before and after a collapse.
constexpr double kLeastTurn = 0.2;

// Quadrics of faces weighed by area, and planes that stand on open edges.
template <class MeshT>
class QuadricModule : public OpenMesh::Decimater::ModBaseT<MeshT> {
 public:
  DECIMATING_MODULE(QuadricModule, MeshT, DeltazQuadric);

  explicit QuadricModule(MeshT& mesh) : Base(mesh, false) {}

  void initialize() override {
    MeshT& mesh = Base::mesh();
    quadrics_.assign(mesh.n_vertices(), Quadric());
    outward_.assign(mesh.n_vertices(), Point(0, 0, 0));
    for (const auto face : mesh.faces()) {
      std::array<typename MeshT::VertexHandle, 3> corners;
      std::size_t count = 0;
      for (const auto vertex : mesh.fv_range(face)) corners[count++] = vertex;
      const Point a = mesh.point(corners[0]);
      const Point across = (mesh.point(corners[1]) - a) % (mesh.point(corners[2]) - a);
      const double size = across.norm();
      if (!(size > 0)) continue;
      const Point normal = across / size;
      Quadric plane(normal[0], normal[1], normal[2], -(normal | a));
      plane *= size / 2;
      for (const auto vertex : corners) {
        quadrics_[number(vertex)] += plane;
        outward_[number(vertex)] += across;
      }
      for (const auto halfedge : mesh.fh_range(face)) {
        if (!mesh.is_boundary(mesh.opposite_halfedge_handle(halfedge))) continue;
        const auto from = mesh.from_vertex_handle(halfedge), to = mesh.to_vertex_handle(halfedge);
        const Point edge = mesh.point(to) - mesh.point(from);
        const Point side = edge % normal;
        const double width = side.norm();
        if (!(width > 0)) continue;
        const Point upright = side / width;
        Quadric wall(upright[0], upright[1], upright[2], -(upright | mesh.point(from)));
        wall *= kBorderWeight * edge.sqrnorm();
        quadrics_[number(from)] += wall;
        quadrics_[number(to)] += wall;
      }
    }
  }

  float collapse_priority(const typename Base::CollapseInfo& info) override {
    MeshT& mesh = Base::mesh();
    for (const auto face : mesh.vf_range(info.v0)) {
      if (face == info.fl || face == info.fr) continue;
      std::array<Point, 3> before, after;
      std::array<typename MeshT::VertexHandle, 3> corners;
      std::size_t count = 0;
      for (const auto vertex : mesh.fv_range(face)) {
        corners[count] = vertex == info.v0 ? info.v1 : vertex;
        before[count] = mesh.point(vertex);
        after[count] = vertex == info.v0 ? info.p1 : before[count];
        ++count;
      }
      const Point n = (before[1] - before[0]) % (before[2] - before[0]);
      const Point m = (after[1] - after[0]) % (after[2] - after[0]);
      // Written so that a triangle without area, and anything that is no number, is refused.
      if (!((n | m) > kLeastTurn * n.norm() * m.norm())) return static_cast<float>(Base::ILLEGAL_COLLAPSE);
      // Many small turns make a whole one: against the finest surface at each of its corners.
      if (std::all_of(corners.begin(), corners.end(),
                      [&](const auto vertex) { return (outward_[number(vertex)] | m) < 0; }))
        return static_cast<float>(Base::ILLEGAL_COLLAPSE);
    }
    Quadric sum = quadrics_[number(info.v0)];
    sum += quadrics_[number(info.v1)];
    const double error = std::max(0.0, sum(info.p1));
    return static_cast<float>(std::min(error, 1e30));
  }

  void postprocess_collapse(const typename Base::CollapseInfo& info) override {
    quadrics_[number(info.v1)] += quadrics_[number(info.v0)];
  }

 private:
  static std::size_t number(typename MeshT::VertexHandle vertex) {
    return static_cast<std::size_t>(vertex.idx());
  }
  std::vector<Quadric> quadrics_;
  std::vector<Point> outward_;  // of the finest mesh, weighed by area
};

using Decimater = OpenMesh::Decimater::DecimaterT<HalfedgeMesh>;

// The mesh with vertices doubled wherever a triangle would not fit the edges that are there; `original` gets
// the vertex each stands for.
void fill(const TriangleView& source, HalfedgeMesh& mesh, std::vector<std::uint32_t>& original) {
  const auto addVertex = [&](std::uint32_t v) {
    const Vector3& p = source.positions[v];
    original.push_back(v);
    return mesh.add_vertex({p.x, p.y, p.z});
  };
  std::vector<HalfedgeMesh::VertexHandle> vertices;
  for (std::uint32_t v = 0; v < source.positions.size(); ++v) vertices.push_back(addVertex(v));
  for (const auto& [a, b, c] : source.triangles) {
    if (mesh.add_face(vertices[a], vertices[b], vertices[c]).is_valid()) continue;
    const auto x = addVertex(a), y = addVertex(b), z = addVertex(c);
    mesh.add_face(x, y, z);
  }
}

DecimatedMesh facesOf(const HalfedgeMesh& mesh, const std::vector<std::uint32_t>& original) {
  DecimatedMesh result;
  for (const auto face : mesh.faces()) {
    if (mesh.status(face).deleted()) continue;
    std::array<std::uint32_t, 3> triangle{};
    std::size_t count = 0;
    for (const auto vertex : mesh.fv_range(face))
      triangle[count++] = original[static_cast<std::size_t>(vertex.idx())];
    result.triangles.push_back(triangle);
  }
  return result;
}

}  // namespace

std::vector<DecimatedMesh> decimateMesh(const TriangleView& source, std::span<const std::size_t> targets) {
  // OpenMesh remarks on every edge it refuses.
  omerr().disconnect(std::cerr);
  HalfedgeMesh mesh;
  mesh.request_face_status();
  mesh.request_edge_status();
  mesh.request_halfedge_status();
  mesh.request_vertex_status();
  std::vector<std::uint32_t> original;
  fill(source, mesh, original);
  std::vector<DecimatedMesh> results;
  Decimater decimater(mesh);
  QuadricModule<HalfedgeMesh>::Handle module;
  decimater.add(module);
  if (!decimater.initialize()) return results;
  std::size_t faces = mesh.n_faces();
  for (const std::size_t target : targets) {
    // The decimater counts those it deleted in an earlier round as if they were there.
    if (faces > target) decimater.decimate_to_faces(0, target + (mesh.n_faces() - faces));
    results.push_back(facesOf(mesh, original));
    faces = results.back().triangles.size();
  }
  return results;
}

}  // namespace deltaz
