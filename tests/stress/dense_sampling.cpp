#include "tests/stress/dense_sampling.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <random>
#include <stdexcept>
#include <utility>

namespace deltaz {
namespace {

// A place between posts: indices of level 0 with fractions, and the line along the ellipsoid normal there.
struct Place {
  double column = 0, row = 0;
  Vector3 foot, up;
};

class Surface {
 public:
  Surface(const RawGrid& grid, const GridGeometry& geometry, int level)
      : grid_(grid), geometry_(geometry), step_(std::int64_t{1} << level) {}

  std::optional<double> heightAt(const Place& place) const {
    const auto column = static_cast<std::int64_t>(std::floor(place.column / static_cast<double>(step_)));
    const auto row = static_cast<std::int64_t>(std::floor(place.row / static_cast<double>(step_)));
    for (std::int64_t j = row - 1; j <= row + 1; ++j) {
      for (std::int64_t i = column - 1; i <= column + 1; ++i) {
        if (const auto h = onFacet(place, at(i, j), at(i + 1, j), at(i + 1, j + 1))) return h;
        if (const auto h = onFacet(place, at(i, j), at(i + 1, j + 1), at(i, j + 1))) return h;
      }
    }
    return std::nullopt;
  }

 private:
  std::optional<Vector3> at(std::int64_t i, std::int64_t j) const {
    const std::int64_t column = i * step_ - grid_.header.x_axis.first;
    const std::int64_t row = j * step_ - grid_.header.y_axis.first;
    if (column < 0 || column >= grid_.header.x_axis.count || row < 0 || row >= grid_.header.y_axis.count ||
        !grid_.isValid(column, row))
      return std::nullopt;
    return geometry_.placeAt(i * step_, j * step_).at(geometry_.metres(grid_.height(column, row)));
  }

  // The line passes the facet if it passes all three edges on the same side.
  static std::optional<double> onFacet(const Place& place, const std::optional<Vector3>& a,
                                       const std::optional<Vector3>& b, const std::optional<Vector3>& c) {
    if (!a || !b || !c) return std::nullopt;
    const Vector3 pa = *a - place.foot, pb = *b - place.foot, pc = *c - place.foot;
    if (!(dot(place.up, cross(pa, pb)) >= 0 && dot(place.up, cross(pb, pc)) >= 0 &&
          dot(place.up, cross(pc, pa)) >= 0))
      return std::nullopt;
    const Vector3 normal = cross(*b - *a, *c - *a);
    const double slope = dot(place.up, normal);
    // Facets of no extent, at a pole, have no height.
    if (!(slope > 1e-9 * length(*b - *a) * length(*c - *a))) return std::nullopt;
    return dot(pa, normal) / slope;
  }

  const RawGrid& grid_;
  const GridGeometry& geometry_;
  std::int64_t step_;
};

Place placeOf(const GridGeometry& geometry, double column, double row) {
  const GridHeader& header = geometry.header();
  GeodeticPoint point;
  if (geometry.isGeodetic()) {
    point.longitude = kLongitudeOrigin.coordinate + (column + header.x_axis.phase) * header.x_axis.spacing;
    point.latitude = kLatitudeOrigin.coordinate + (row + header.y_axis.phase) * header.y_axis.spacing;
  } else {
    // Somewhere in that cell is enough: what counts is the line, not which indices led to it.
    const auto i = static_cast<std::int64_t>(std::floor(column)),
               j = static_cast<std::int64_t>(std::floor(row));
    const double x = column - static_cast<double>(i), y = row - static_cast<double>(j);
    const auto foot = [&](std::int64_t di, std::int64_t dj) { return geometry.placeAt(i + di, j + dj).foot; };
    point = toGeodetic(header.ellipsoid, (foot(0, 0) * (1 - x) + foot(1, 0) * x) * (1 - y) +
                                             (foot(0, 1) * (1 - x) + foot(1, 1) * x) * y);
  }
  const RowConstants row_constants = rowConstants(header.ellipsoid, point.latitude);
  const ColumnConstants column_constants = columnConstants(point.longitude);
  return {column, row, earthCentred(row_constants, column_constants, 0),
          upVector(row_constants, column_constants)};
}

}  // namespace

DenseSampling sampleErrors(const Database& database, const RawGrid& grid, int count) {
  const GridGeometry& geometry = database.grid(0);
  const GridHeader& header = geometry.header();
  const Surface fine(grid, geometry, 0);
  std::mt19937 random(11);
  const auto between = [&](const GridAxis& axis) {
    const double first = static_cast<double>(axis.first), last = first + static_cast<double>(axis.count - 1);
    return std::uniform_real_distribution<double>(first, last)(random);
  };
  DenseSampling result;
  for (int level = 1; level < header.level_count; ++level) {
    const Result<std::vector<Node>> nodes = nodesOfLevel(database, 0, level);
    if (!nodes.ok()) throw std::runtime_error(nodes.error().message());
    std::map<std::pair<std::int64_t, std::int64_t>, double> stored;
    for (const Node& node : nodes.value()) {
      if (!node.record.isEmpty() && node.geometricError() < std::numeric_limits<double>::infinity())
        ++result.known;
      stored[{node.record.x, node.record.y}] = node.geometricError();
    }
    const Surface coarse(grid, geometry, level);
    const double span =
        static_cast<double>(header.leaf_cells) * static_cast<double>(std::int64_t{1} << level);
    for (int sample = 0; sample < count; ++sample) {
      const Place place = placeOf(geometry, between(header.x_axis), between(header.y_axis));
      const auto node = stored.find({static_cast<std::int64_t>(std::floor(place.column / span)),
                                     static_cast<std::int64_t>(std::floor(place.row / span))});
      if (node == stored.end() || !(node->second < std::numeric_limits<double>::infinity())) continue;
      const auto full = fine.heightAt(place), simplified = coarse.heightAt(place);
      if (!full || !simplified) continue;
      const double error = std::abs(*full - *simplified);
      ++result.samples;
      if (node->second > 0) result.share = std::max(result.share, error / node->second);
      result.excess = std::max(result.excess, error - node->second);
    }
  }
  return result;
}

}  // namespace deltaz
