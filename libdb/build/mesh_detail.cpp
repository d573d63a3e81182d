#include "libdb/build/mesh_detail.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "libdb/access/color.h"
#include "libdb/build/mesh_decimation.h"
#include "libdb/build/mesh_distance.h"
#include "libdb/build/mesh_packing.h"

namespace deltaz {

namespace {

constexpr std::uint32_t kUnused = 0xFFFFFFFF;

std::vector<Vector3> toVectors(const std::vector<std::array<float, 3>>& positions) {
  std::vector<Vector3> vectors;
  for (const auto& [x, y, z] : positions)
    vectors.push_back({static_cast<double>(x), static_cast<double>(y), static_cast<double>(z)});
  return vectors;
}

double radiusOf(const std::vector<Vector3>& positions) {
  Vector3 low = positions.front(), high = positions.front();
  for (const Vector3& p : positions) {
    low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
  }
  return length(high - low) / 2;
}

LinearColor linearOf(const SrgbColor& color) {
  return {decodeSrgb(color[0]), decodeSrgb(color[1]), decodeSrgb(color[2])};
}

SrgbColor encoded(const LinearColor& color) {
  return {encodeSrgb(color.red), encodeSrgb(color.green), encodeSrgb(color.blue)};
}

// Looks up in the finest mesh what a coarser one is to show.
class FinestLook {
 public:
  FinestLook(const ImportedMesh& finest, const NearestTriangle& nearest, bool curved)
      : finest_(finest), nearest_(nearest), curved_(curved) {
    by_triangle_ = std::all_of(finest.colors.begin(), finest.colors.end(), [](const auto& colors) {
      return colors[0] == colors[1] && colors[1] == colors[2];
    });
  }

  // The coarser mesh with colours and normals; its vertices are those of the finest that it uses.
  ImportedMesh dress(const DecimatedMesh& bare, const std::vector<Vector3>& positions) const {
    ImportedMesh mesh;
    mesh.two_sided = finest_.two_sided;
    std::vector<std::uint32_t> becomes(positions.size(), kUnused);
    for (const auto& triangle : bare.triangles) {
      const std::array<Vector3, 3> corners = {positions[triangle[0]], positions[triangle[1]],
                                              positions[triangle[2]]};
      const Vector3 across = cross(corners[1] - corners[0], corners[2] - corners[0]);
      if (!(length(across) > 0)) continue;
      std::array<std::uint32_t, 3> numbers{};
      for (std::size_t k = 0; k < 3; ++k) {
        std::uint32_t& number = becomes[triangle[k]];
        if (number == kUnused) {
          number = static_cast<std::uint32_t>(mesh.positions.size());
          mesh.positions.push_back(finest_.positions[triangle[k]]);
        }
        numbers[k] = number;
      }
      mesh.triangles.push_back(numbers);
      mesh.colors.push_back(colorsOf(corners));
      if (curved_) mesh.normals.push_back(normalsOf(corners, normalized(across)));
    }
    return mesh;
  }

 private:
  // A little inside the triangle, so that of the faces that meet at a corner the one below is found.
  static Vector3 nearCorner(const std::array<Vector3, 3>& corners, std::size_t k) {
    const Vector3 middle = (corners[0] + corners[1] + corners[2]) * (1.0 / 3);
    return corners[k] * 0.98 + middle * 0.02;
  }

  std::array<SrgbColor, 3> colorsOf(const std::array<Vector3, 3>& corners) const {
    if (by_triangle_) {
      // The mean over the middles of four equal parts.
      const Vector3 middle = (corners[0] + corners[1] + corners[2]) * (1.0 / 3);
      LinearColor sum = linearOf(finest_.colors[nearest_.find(middle)][0]);
      for (const Vector3& corner : corners)
        sum = sum + linearOf(finest_.colors[nearest_.find((corner + middle) * 0.5)][0]);
      const SrgbColor color = encoded(sum * 0.25);
      return {color, color, color};
    }
    std::array<SrgbColor, 3> colors{};
    for (std::size_t k = 0; k < 3; ++k) {
      const Vector3 p = nearCorner(corners, k);
      const std::size_t t = nearest_.find(p);
      const std::array<double, 3> w = nearestWeights(nearest_.mesh().corners(t), p);
      LinearColor color;
      for (std::size_t c = 0; c < 3; ++c) color = color + linearOf(finest_.colors[t][c]) * w[c];
      colors[k] = encoded(color);
    }
    return colors;
  }

  std::array<std::array<float, 3>, 3> normalsOf(const std::array<Vector3, 3>& corners,
                                                const Vector3& flat) const {
    std::array<std::array<float, 3>, 3> normals{};
    for (std::size_t k = 0; k < 3; ++k) {
      const Vector3 p = nearCorner(corners, k);
      const std::size_t t = nearest_.find(p);
      const std::array<double, 3> w = nearestWeights(nearest_.mesh().corners(t), p);
      Vector3 sum;
      for (std::size_t c = 0; c < 3; ++c) {
        const auto& [x, y, z] = finest_.normals[t][c];
        sum = sum + Vector3{static_cast<double>(x), static_cast<double>(y), static_cast<double>(z)} * w[c];
      }
      // A thin sheet's other side may be the nearest; its normals would shade this side black.
      const Vector3 n = dot(sum, flat) > 0 ? normalized(sum) : flat;
      normals[k] = {static_cast<float>(n.x), static_cast<float>(n.y), static_cast<float>(n.z)};
    }
    return normals;
  }

  const ImportedMesh& finest_;
  const NearestTriangle& nearest_;
  bool curved_, by_triangle_ = true;
};

std::vector<std::size_t> targetsOf(std::size_t triangles, std::size_t levels) {
  std::vector<std::size_t> targets;
  while (triangles >= kCoarsestTriangles && targets.size() + 1 < levels) targets.push_back(triangles /= 2);
  return targets;
}

// Rounded up, so that neither the conversion nor the rounding of coordinates makes it too small.
float storedError(double bound, double radius) {
  const double value = bound + radius * 1e-12;
  const auto stored = static_cast<float>(value);
  return static_cast<double>(stored) >= value
             ? stored
             : std::nextafter(stored, std::numeric_limits<float>::infinity());
}

}  // namespace

std::vector<FinishedLod> makeDetailLevels(const ImportedMesh& mesh, std::size_t levels) {
  std::vector<FinishedLod> lods;
  lods.push_back({packMesh(mesh), 0});
  const std::vector<std::size_t> targets =
      targetsOf(mesh.triangles.size(), std::min<std::size_t>(levels, kMaximumPartLods));
  if (targets.empty()) return lods;
  const std::vector<Vector3> positions = toVectors(mesh.positions);
  const double radius = radiusOf(positions);
  const TriangleView view{positions, mesh.triangles};
  const NearestTriangle finest(view);
  const FinestLook look(mesh, finest, lods.front().mesh.curveShaded());
  for (const DecimatedMesh& bare : decimateMesh(view, targets)) {
    const ImportedMesh coarse = look.dress(bare, positions);
    if (coarse.triangles.empty()) break;
    // A level that saves next to nothing is not worth its bytes.
    if (coarse.triangles.size() * 10 > lods.back().mesh.triangles.size() * 9) continue;
    const std::vector<Vector3> coarse_positions = toVectors(coarse.positions);
    const NearestTriangle found(TriangleView{coarse_positions, coarse.triangles});
    const float error = storedError(meshDistanceBound(finest, found, radius * kDistanceSlackInRadii), radius);
    if (static_cast<double>(error) > radius * kLargestErrorInRadii) break;
    // A finer level that is no better than this one has nothing to offer.
    while (lods.size() > 1 && lods.back().error >= error) lods.pop_back();
    lods.push_back({packMesh(coarse), error});
  }
  return lods;
}

}  // namespace deltaz
