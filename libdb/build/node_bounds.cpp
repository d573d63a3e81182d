#include "libdb/build/node_bounds.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "libdb/access/plan_shape.h"

namespace deltaz {

namespace {

constexpr double kConeUnit = std::numbers::pi / 65535.0;
// Added before rounding up, to stay outside whatever the last bits of a distance or an angle were.
constexpr double kRoundingGuard = 1e-6;

std::int64_t toCentroidUnits(double metres) {
  return std::llround(metres / kCentroidUnit);
}

Vector3 fromCentroidUnits(const std::array<std::int64_t, 3>& units) {
  return {static_cast<double>(units[0]) * kCentroidUnit, static_cast<double>(units[1]) * kCentroidUnit,
          static_cast<double>(units[2]) * kCentroidUnit};
}

std::uint32_t radiusUnits(double metres) {
  // What a record cannot hold becomes the largest value, which GridBuild::checkExtent refuses.
  constexpr double kMost = std::numeric_limits<std::uint32_t>::max();
  return static_cast<std::uint32_t>(std::min(kMost, std::ceil(metres / kCentroidUnit + kRoundingGuard)));
}

std::array<std::int16_t, 3> packNormal(const Vector3& normal) {
  const auto pack = [](double component) {
    return static_cast<std::int16_t>(std::lround(component * 32767.0));
  };
  return {pack(normal.x), pack(normal.y), pack(normal.z)};
}

std::uint16_t coneUnits(double angle) {
  return static_cast<std::uint16_t>(std::min(65535.0, std::ceil(angle / kConeUnit + kRoundingGuard)));
}

// Exact for small and for large angles, where the arc cosine of the dot product is not.
double angleBetween(const Vector3& a, const Vector3& b) {
  return std::atan2(length(cross(a, b)), dot(a, b));
}

}  // namespace

Vector3 unpackNormal(const std::array<std::int16_t, 3>& packed) {
  const Vector3 normal{static_cast<double>(packed[0]), static_cast<double>(packed[1]),
                       static_cast<double>(packed[2])};
  const double size = length(normal);
  return size > 0 ? normal * (1.0 / size) : Vector3{1, 0, 0};
}

double coneAngle(std::uint16_t units) {
  return static_cast<double>(units) * kConeUnit;
}

TileSummary summarizeTile(const TerrainTile& tile, const GridGeometry& geometry) {
  TileSummary summary;
  NodeBounds& bounds = summary.bounds;
  const std::vector<PostPlace> places =
      geometry.postPlaces(tile.level, {tile.first_column, tile.first_column + tile.columns},
                          {tile.first_row, tile.first_row + tile.rows});
  const auto placeOf = [&](int i, int j) -> const PostPlace& {
    return places[static_cast<std::size_t>(j) * static_cast<std::size_t>(tile.columns) +
                  static_cast<std::size_t>(i)];
  };
  const auto place = [&](int i, int j) { return placeOf(i, j).at(geometry.metres(tile.height(i, j))); };

  Vector3 low, high;
  for (int j = 0; j < tile.rows; ++j) {
    for (int i = 0; i < tile.columns; ++i) {
      if (!tile.isValid(i, j)) {
        ++summary.void_posts;
        continue;
      }
      const Vector3 p = place(i, j);
      const std::int32_t height = tile.height(i, j);
      if (summary.valid_posts++ == 0) {
        low = high = p;
        bounds.minimum_height = bounds.maximum_height = height;
      }
      low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
      high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
      bounds.minimum_height = std::min(bounds.minimum_height, height);
      bounds.maximum_height = std::max(bounds.maximum_height, height);
    }
  }
  if (summary.valid_posts == 0) return summary;
  bounds.empty = false;
  bounds.centroid = {toCentroidUnits((low.x + high.x) / 2), toCentroidUnits((low.y + high.y) / 2),
                     toCentroidUnits((low.z + high.z) / 2)};

  const Vector3 centre = fromCentroidUnits(bounds.centroid);
  double farthest = 0;
  Vector3 normal_sum;
  std::vector<Vector3> normals;
  const auto addFacet = [&](std::array<int, 2> at_a, std::array<int, 2> at_b, std::array<int, 2> at_c,
                            const Vector3& up) {
    const Vector3 a = place(at_a[0], at_a[1]), b = place(at_b[0], at_b[1]), c = place(at_c[0], at_c[1]);
    const Vector3 normal = cross(b - a, c - a);
    const double size = length(normal);
    if (!(size > 0)) return;
    ++summary.facets;
    normal_sum = normal_sum + normal;
    normals.push_back(normal * (1.0 / size));
    const double rise = dot(normals.back(), up);
    const double slope =
        rise > 0 ? length(cross(normals.back(), up)) / rise : std::numeric_limits<double>::infinity();
    // Looked at last, since hardly a facet is steeper than all before it.
    if (slope > summary.steepest &&
        coversGround(placeOf(at_a[0], at_a[1]).foot, placeOf(at_b[0], at_b[1]).foot,
                     placeOf(at_c[0], at_c[1]).foot))
      summary.steepest = slope;
  };
  for (int j = 0; j < tile.rows; ++j) {
    for (int i = 0; i < tile.columns; ++i) {
      if (!tile.isValid(i, j)) continue;
      farthest = std::max(farthest, length(place(i, j) - centre));
      if (i + 1 >= tile.columns || j + 1 >= tile.rows) continue;
      const Vector3& up = placeOf(i, j).up;
      if (tile.bottomFaceValid(i, j)) addFacet({i, j}, {i + 1, j}, {i + 1, j + 1}, up);
      if (tile.topFaceValid(i, j)) addFacet({i, j}, {i + 1, j + 1}, {i, j + 1}, up);
    }
  }
  bounds.radius = radiusUnits(farthest);
  if (!normals.empty() && length(normal_sum) > 0) {
    bounds.has_cone = true;
    bounds.mean_normal = packNormal(normalized(normal_sum));
    const Vector3 axis = unpackNormal(bounds.mean_normal);
    double widest = 0;
    for (const Vector3& normal : normals) widest = std::max(widest, angleBetween(axis, normal));
    bounds.cone_half_angle = coneUnits(widest);
  }
  return summary;
}

void includeFace(NodeBounds& bounds, const std::array<Vector3, 3>& face) {
  const Vector3 centre = fromCentroidUnits(bounds.centroid);
  for (const Vector3& vertex : face)
    bounds.radius = std::max(bounds.radius, radiusUnits(length(vertex - centre)));
  const Vector3 normal = cross(face[1] - face[0], face[2] - face[0]);
  if (!(length(normal) > 0)) return;
  if (!bounds.has_cone) {
    bounds.has_cone = true;
    bounds.mean_normal = packNormal(normalized(normal));
  }
  bounds.cone_half_angle =
      std::max(bounds.cone_half_angle, coneUnits(angleBetween(unpackNormal(bounds.mean_normal), normal)));
}

void includeChildren(NodeBounds& parent, std::span<const NodeBounds> children) {
  bool first = parent.empty;
  std::array<std::int64_t, 3> low{}, high{};
  for (const NodeBounds& child : children) {
    if (child.empty) continue;
    if (first) {
      parent.minimum_height = child.minimum_height;
      parent.maximum_height = child.maximum_height;
      low = high = child.centroid;
      first = false;
    }
    parent.minimum_height = std::min(parent.minimum_height, child.minimum_height);
    parent.maximum_height = std::max(parent.maximum_height, child.maximum_height);
    for (std::size_t i = 0; i < 3; ++i) {
      low[i] = std::min(low[i], child.centroid[i]);
      high[i] = std::max(high[i], child.centroid[i]);
    }
  }
  if (first) return;  // nothing anywhere
  if (parent.empty) {
    parent.empty = false;
    for (std::size_t i = 0; i < 3; ++i) parent.centroid[i] = low[i] + (high[i] - low[i]) / 2;
  }
  const Vector3 centre = fromCentroidUnits(parent.centroid);
  double farthest = static_cast<double>(parent.radius) * kCentroidUnit;
  for (const NodeBounds& child : children) {
    if (child.empty) continue;
    farthest = std::max(farthest, length(fromCentroidUnits(child.centroid) - centre) +
                                      static_cast<double>(child.radius) * kCentroidUnit);
    if (!child.has_cone) continue;
    if (!parent.has_cone) {
      parent.has_cone = true;
      parent.mean_normal = child.mean_normal;
      parent.cone_half_angle = child.cone_half_angle;
    }
  }
  parent.radius = radiusUnits(farthest);
  const Vector3 axis = unpackNormal(parent.mean_normal);
  for (const NodeBounds& child : children) {
    if (child.empty || !child.has_cone) continue;
    const double angle =
        angleBetween(axis, unpackNormal(child.mean_normal)) + coneAngle(child.cone_half_angle);
    parent.cone_half_angle = std::max(parent.cone_half_angle, coneUnits(angle));
  }
}

}  // namespace deltaz
