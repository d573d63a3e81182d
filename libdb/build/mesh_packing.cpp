#include "libdb/build/mesh_packing.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <tuple>

#include "libdb/access/vector3.h"

namespace deltaz {

namespace {

using StoredNormal = std::array<std::int16_t, 3>;

Vector3 toVector(const std::array<float, 3>& p) {
  return {static_cast<double>(p[0]), static_cast<double>(p[1]), static_cast<double>(p[2])};
}

bool isCurved(const ImportedMesh& mesh) {
  const double least = std::cos(kFlatNormalDegrees * std::numbers::pi / 180);
  for (std::size_t t = 0; t < mesh.normals.size(); ++t) {
    const auto& [a, b, c] = mesh.triangles[t];
    const Vector3 origin = toVector(mesh.positions[a]);
    const Vector3 across =
        normalized(cross(toVector(mesh.positions[b]) - origin, toVector(mesh.positions[c]) - origin));
    for (const auto& normal : mesh.normals[t]) {
      if (dot(across, toVector(normal)) < least) return true;
    }
  }
  return false;
}

StoredNormal storedNormal(const std::array<float, 3>& normal) {
  StoredNormal stored{};
  for (std::size_t k = 0; k < 3; ++k) {
    const double value = std::clamp(static_cast<double>(normal[k]), -1.0, 1.0);
    stored[k] = static_cast<std::int16_t>(std::lround(value * kModelNormalScale));
  }
  return stored;
}

bool isColoredByTriangle(const ImportedMesh& mesh) {
  return std::all_of(mesh.colors.begin(), mesh.colors.end(), [](const std::array<SrgbColor, 3>& colors) {
    return colors[0] == colors[1] && colors[1] == colors[2];
  });
}

ModelMesh pack(const ImportedMesh& mesh, bool curved, bool by_vertex) {
  ModelMesh packed;
  packed.two_sided = mesh.two_sided;
  packed.colored_by_vertex = by_vertex;
  std::map<std::tuple<std::uint32_t, StoredNormal, SrgbColor>, std::uint32_t> numbers;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    std::array<std::uint32_t, 3> corners{};
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t at = mesh.triangles[t][k];
      const StoredNormal normal = curved ? storedNormal(mesh.normals[t][k]) : StoredNormal{};
      const SrgbColor color = by_vertex ? mesh.colors[t][k] : SrgbColor{};
      const auto [place, fresh] =
          numbers.emplace(std::tuple(at, normal, color), static_cast<std::uint32_t>(packed.vertices.size()));
      if (fresh) {
        packed.vertices.push_back(mesh.positions[at]);
        if (curved) packed.normals.push_back(normal);
        if (by_vertex) packed.colors.push_back(color);
      }
      corners[k] = place->second;
    }
    packed.triangles.push_back(corners);
    if (!by_vertex) packed.colors.push_back(mesh.colors[t][0]);
  }
  return packed;
}

std::size_t bytesOf(const ModelMesh& mesh) {
  return mesh.vertices.size() * vertexBytes(mesh) + mesh.triangles.size() * triangleBytes(mesh);
}

}  // namespace

ModelMesh packMesh(const ImportedMesh& mesh) {
  const bool curved = !mesh.normals.empty() && isCurved(mesh);
  ModelMesh by_vertex = pack(mesh, curved, true);
  if (!isColoredByTriangle(mesh)) return by_vertex;
  ModelMesh by_triangle = pack(mesh, curved, false);
  return bytesOf(by_vertex) < bytesOf(by_triangle) ? by_vertex : by_triangle;
}

}  // namespace deltaz
