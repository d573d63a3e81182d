#include "libdb/build/mesh_repair.h"

#include <algorithm>
#include <bit>
#include <fmt/format.h>
#include <map>
#include <numeric>
#include <set>
#include <unordered_map>

#include "libdb/access/vector3.h"

namespace deltaz {

namespace {

using Triangle = std::array<std::uint32_t, 3>;

struct PositionHash {
  std::size_t operator()(const std::array<float, 3>& p) const {
    std::size_t hash = 0;
    for (const float value : p)
      hash = hash * 0x9E3779B97F4A7C15 + std::bit_cast<std::uint32_t>(value) + (hash >> 29);
    return hash;
  }
};

void weldVertices(ImportedMesh& mesh, RepairReport& report) {
  std::unordered_map<std::array<float, 3>, std::uint32_t, PositionHash> first_at;
  std::vector<std::uint32_t> becomes;
  std::vector<std::array<float, 3>> kept;
  for (std::array<float, 3> position : mesh.positions) {
    for (float& value : position) value += 0.0F;  // no negative zero
    const auto [place, fresh] = first_at.emplace(position, static_cast<std::uint32_t>(kept.size()));
    if (fresh) kept.push_back(position);
    if (!fresh) ++report.welded_vertices;
    becomes.push_back(place->second);
  }
  mesh.positions = std::move(kept);
  for (Triangle& triangle : mesh.triangles) {
    for (std::uint32_t& index : triangle) index = becomes[index];
  }
}

Vector3 positionOf(const ImportedMesh& mesh, std::uint32_t v) {
  const auto& [x, y, z] = mesh.positions[v];
  return {static_cast<double>(x), static_cast<double>(y), static_cast<double>(z)};
}

Vector3 acrossOf(const ImportedMesh& mesh, const Triangle& t) {
  const Vector3 a = positionOf(mesh, t[0]);
  return cross(positionOf(mesh, t[1]) - a, positionOf(mesh, t[2]) - a);
}

// Keeps the triangles `keep` says.
void filterTriangles(ImportedMesh& mesh, const std::vector<std::uint8_t>& keep) {
  std::size_t next = 0;
  for (std::size_t t = 0; t < keep.size(); ++t) {
    if (keep[t] == 0) continue;
    mesh.triangles[next] = mesh.triangles[t];
    if (!mesh.normals.empty()) mesh.normals[next] = mesh.normals[t];
    if (!mesh.colors.empty()) mesh.colors[next] = mesh.colors[t];
    ++next;
  }
  mesh.triangles.resize(next);
  if (!mesh.normals.empty()) mesh.normals.resize(next);
  if (!mesh.colors.empty()) mesh.colors.resize(next);
}

void dropTriangles(ImportedMesh& mesh, RepairReport& report) {
  std::vector<std::uint8_t> keep(mesh.triangles.size(), 1);
  std::set<Triangle> seen;
  for (std::size_t t = 0; t < keep.size(); ++t) {
    const Triangle& triangle = mesh.triangles[t];
    if (triangle[0] == triangle[1] || triangle[1] == triangle[2] || triangle[2] == triangle[0] ||
        !(length(acrossOf(mesh, triangle)) > 0)) {
      keep[t] = 0;
      ++report.degenerate_triangles;
      continue;
    }
    // Beginning at its least vertex; a triangle and its back side differ.
    Triangle turned = triangle;
    std::rotate(turned.begin(), std::min_element(turned.begin(), turned.end()), turned.end());
    if (!seen.insert(turned).second) {
      keep[t] = 0;
      ++report.duplicate_triangles;
    }
  }
  filterTriangles(mesh, keep);
}

void dropVertices(ImportedMesh& mesh, RepairReport& report) {
  constexpr std::uint32_t kUnused = 0xFFFFFFFF;
  std::vector<std::uint32_t> becomes(mesh.positions.size(), kUnused);
  for (const Triangle& triangle : mesh.triangles) {
    for (const std::uint32_t index : triangle) becomes[index] = 0;
  }
  std::uint32_t next = 0;
  for (std::size_t v = 0; v < becomes.size(); ++v) {
    if (becomes[v] == kUnused) {
      ++report.isolated_vertices;
      continue;
    }
    mesh.positions[next] = mesh.positions[v];
    becomes[v] = next++;
  }
  mesh.positions.resize(next);
  for (Triangle& triangle : mesh.triangles) {
    for (std::uint32_t& index : triangle) index = becomes[index];
  }
}

// Which triangles meet at an edge, and whether they go along it from its lesser vertex to its greater.
struct EdgeSide {
  std::uint32_t triangle = 0;
  bool forward = false;
};
using Edges = std::map<std::array<std::uint32_t, 2>, std::vector<EdgeSide>>;

Edges edgesOf(const ImportedMesh& mesh) {
  Edges edges;
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t from = mesh.triangles[t][k], to = mesh.triangles[t][(k + 1) % 3];
      edges[{std::min(from, to), std::max(from, to)}].push_back({t, from < to});
    }
  }
  return edges;
}

void turnTriangle(ImportedMesh& mesh, std::uint32_t t) {
  std::swap(mesh.triangles[t][1], mesh.triangles[t][2]);
  if (!mesh.colors.empty()) std::swap(mesh.colors[t][1], mesh.colors[t][2]);
  if (mesh.normals.empty()) return;
  std::swap(mesh.normals[t][1], mesh.normals[t][2]);
  // Normals that point to what is inside now were as wrong as the triangle.
  const Vector3 across = acrossOf(mesh, mesh.triangles[t]);
  for (std::array<float, 3>& n : mesh.normals[t]) {
    const Vector3 normal{static_cast<double>(n[0]), static_cast<double>(n[1]), static_cast<double>(n[2])};
    if (dot(normal, across) < 0) n = {-n[0], -n[1], -n[2]};
  }
}

// A shell: the triangles that hang together over edges of two, and how each would have to be turned to agree
// with the first.
struct Shell {
  std::vector<std::uint32_t> triangles;
  bool closed = true;      // no edge of one triangle, none of more than two
  bool agreeing = true;    // as it stands
  bool orientable = true;  // some way of turning makes all agree
};

class Shells {
 public:
  Shells(const ImportedMesh& mesh, const Edges& edges)
      : mesh_(mesh), edges_(edges), known_(mesh.triangles.size(), 0), turned_(mesh.triangles.size(), 0) {}

  Shell gather(std::uint32_t first) {
    Shell shell;
    shell.triangles.push_back(first);
    known_[first] = 1;
    for (std::size_t next = 0; next < shell.triangles.size(); ++next) {
      const std::uint32_t t = shell.triangles[next];
      for (std::size_t k = 0; k < 3; ++k) visitEdge(t, k, shell);
    }
    return shell;
  }
  bool isKnown(std::uint32_t t) const { return known_[t] != 0; }
  bool isTurned(std::uint32_t t) const { return turned_[t] != 0; }

 private:
  void visitEdge(std::uint32_t t, std::size_t k, Shell& shell) {
    const std::uint32_t from = mesh_.triangles[t][k], to = mesh_.triangles[t][(k + 1) % 3];
    const std::vector<EdgeSide>& sides = edges_.at({std::min(from, to), std::max(from, to)});
    if (sides.size() != 2) {
      shell.closed = false;
      return;
    }
    const bool first = sides[0].triangle == t;
    const EdgeSide& other = first ? sides[1] : sides[0];
    // Neighbours that agree pass an edge in opposite directions.
    const bool against = other.forward == (from < to);
    if (against) shell.agreeing = false;
    const auto wanted = static_cast<std::uint8_t>(turned_[t] ^ (against ? 1 : 0));
    if (known_[other.triangle] == 0) {
      known_[other.triangle] = 1;
      turned_[other.triangle] = wanted;
      shell.triangles.push_back(other.triangle);
    } else if (turned_[other.triangle] != wanted) {
      shell.orientable = false;
    }
  }

  const ImportedMesh& mesh_;
  const Edges& edges_;
  std::vector<std::uint8_t> known_, turned_;
};

void turnShells(ImportedMesh& mesh, RepairReport& report) {
  const Edges edges = edgesOf(mesh);
  for (const auto& [edge, sides] : edges) {
    if (sides.size() > 2) ++report.non_manifold_edges;
    if (sides.size() == 1) ++report.open_edges;
  }
  Shells shells(mesh, edges);
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    if (shells.isKnown(t)) continue;
    const Shell shell = shells.gather(t);
    if (!shell.closed || !shell.orientable) continue;
    // Six times the volume once all agree with the first triangle.
    double volume = 0;
    const Vector3 origin = positionOf(mesh, mesh.triangles[t][0]);
    for (const std::uint32_t number : shell.triangles) {
      const auto& [a, b, c] = mesh.triangles[number];
      const double part = dot(positionOf(mesh, a) - origin,
                              cross(positionOf(mesh, b) - origin, positionOf(mesh, c) - origin));
      volume += shells.isTurned(number) ? -part : part;
    }
    if (shell.agreeing) {
      if (volume < 0) ++report.inside_out_shells;
      continue;
    }
    for (const std::uint32_t number : shell.triangles) {
      if (shells.isTurned(number) == (volume < 0)) continue;
      turnTriangle(mesh, number);
      ++report.turned_triangles;
    }
  }
}

}  // namespace

RepairReport& RepairReport::operator+=(const RepairReport& other) {
  welded_vertices += other.welded_vertices;
  isolated_vertices += other.isolated_vertices;
  degenerate_triangles += other.degenerate_triangles;
  duplicate_triangles += other.duplicate_triangles;
  turned_triangles += other.turned_triangles;
  non_manifold_edges += other.non_manifold_edges;
  inside_out_shells += other.inside_out_shells;
  open_edges += other.open_edges;
  return *this;
}

std::vector<std::string> RepairReport::lines() const {
  std::vector<std::string> lines;
  const auto say = [&](std::size_t count, const char* one, const char* several, const char* what) {
    if (count > 0) lines.push_back(fmt::format("{} {} {}", count, count == 1 ? one : several, what));
  };
  say(welded_vertices, "vertex", "vertices", "joined with others at the same place");
  say(isolated_vertices, "vertex", "vertices", "of no triangle dropped");
  say(degenerate_triangles, "triangle", "triangles", "without an area dropped");
  say(duplicate_triangles, "triangle", "triangles", "given twice dropped");
  say(turned_triangles, "triangle", "triangles", "of closed shells turned to face outwards");
  say(non_manifold_edges, "edge", "edges", "of more than two triangles kept");
  say(inside_out_shells, "closed shell that faces", "closed shells that face",
      "inwards kept: drawn inside out; turn the triangles over in the program that made it to mend that");
  return lines;
}

RepairReport repairMesh(ImportedMesh& mesh) {
  RepairReport report;
  weldVertices(mesh, report);
  dropTriangles(mesh, report);
  dropVertices(mesh, report);
  turnShells(mesh, report);
  return report;
}

}  // namespace deltaz
