#include "libdb/build/face_cutter.h"

#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>
#include <map>
#include <set>
#include <vector>

namespace deltaz {

namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
constexpr std::uint32_t kUnnumbered = 0xFFFFFFFF;

struct Number {
  std::uint32_t value = kUnnumbered;
};
using VertexBase = CGAL::Triangulation_vertex_base_with_info_2<Number, Kernel>;
using FaceBase = CGAL::Constrained_triangulation_face_base_2<Kernel>;
using Structure = CGAL::Triangulation_data_structure_2<VertexBase, FaceBase>;
using Triangulation =
    CGAL::Constrained_Delaunay_triangulation_2<Kernel, Structure, CGAL::Exact_predicates_tag>;

}  // namespace

std::optional<std::vector<CutTriangle>> cutFace(std::span<const CutPoint> border,
                                                std::span<const CutPoint> inner,
                                                std::span<const std::array<std::uint32_t, 2>> lines) {
  Triangulation triangulation;
  std::map<std::uint32_t, Triangulation::Vertex_handle> vertices;
  const auto insert = [&](const CutPoint& point) {
    const auto vertex = triangulation.insert({point.x, point.y});
    if (vertex->info().value == kUnnumbered) vertex->info().value = point.number;
    vertices.emplace(point.number, vertex);
  };
  for (const CutPoint& point : border) insert(point);
  for (const CutPoint& point : inner) insert(point);
  for (std::size_t k = 0; k < border.size(); ++k) {
    triangulation.insert_constraint(vertices.at(border[k].number),
                                    vertices.at(border[(k + 1) % border.size()].number));
  }
  for (const auto& line : lines) {
    const auto from = vertices.at(line[0]), to = vertices.at(line[1]);
    if (from != to) triangulation.insert_constraint(from, to);
  }
  for (const auto vertex : triangulation.finite_vertex_handles()) {
    if (vertex->info().value == kUnnumbered) return std::nullopt;
  }

  std::set<std::array<std::uint32_t, 2>> directed(lines.begin(), lines.end());
  std::map<Triangulation::Face_handle, CutPart> parts;
  std::vector<Triangulation::Face_handle> waiting;
  const auto ends = [](Triangulation::Face_handle face, int edge) {
    return std::array<std::uint32_t, 2>{face->vertex(Triangulation::ccw(edge))->info().value,
                                        face->vertex(Triangulation::cw(edge))->info().value};
  };
  for (const auto face : triangulation.finite_face_handles()) {
    CutPart part = CutPart::kUndecided;
    for (int edge = 0; edge < 3; ++edge) {
      const auto [from, to] = ends(face, edge);
      if (directed.contains({from, to})) part = CutPart::kInside;
      if (part == CutPart::kUndecided && directed.contains({to, from})) part = CutPart::kOutside;
    }
    parts[face] = part;
    if (part != CutPart::kUndecided) waiting.push_back(face);
  }
  // The side spreads over everything no line separates.
  while (!waiting.empty()) {
    const auto face = waiting.back();
    waiting.pop_back();
    for (int edge = 0; edge < 3; ++edge) {
      const auto next = face->neighbor(edge);
      const auto [from, to] = ends(face, edge);
      if (triangulation.is_infinite(next) || parts[next] != CutPart::kUndecided) continue;
      if (directed.contains({from, to}) || directed.contains({to, from})) continue;
      parts[next] = parts[face];
      waiting.push_back(next);
    }
  }
  std::vector<CutTriangle> triangles;
  for (const auto face : triangulation.finite_face_handles()) {
    triangles.push_back(
        {{face->vertex(0)->info().value, face->vertex(1)->info().value, face->vertex(2)->info().value},
         parts[face]});
  }
  return triangles;
}

}  // namespace deltaz
