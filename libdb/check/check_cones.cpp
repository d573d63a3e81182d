// Normal cones hold every facet of the node and below and are no wider than that needs; mean normals are
// those of the facets; vertex normals of shared posts are the same from both sides of a border.
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <limits>
#include <numbers>

#include "libdb/access/plan_shape.h"
#include "libdb/access/vertex_normals.h"
#include "libdb/check/check_geometry.h"
#include "libdb/check/parallel_report.h"
#include "libdb/check/report_detail.h"

namespace deltaz {
namespace {

constexpr double kConeUnit = std::numbers::pi / 65535.0;
constexpr double kAngleRounding = 1e-9;  // radians
// A stored cone may be wider than needed by this many units, and a stored component off by this many of its
// own: roundings of the axis and of the angle itself.
constexpr double kConeUnits = 2;
constexpr double kNormalUnits = 2;

double angleBetween(const Vector3& a, const Vector3& b) {
  return std::atan2(length(cross(a, b)), dot(a, b));
}

struct Cone {
  Vector3 axis{1, 0, 0};
  double angle = 0, cosine = 1;
};

Cone coneOf(const NodeRecord& record) {
  const Vector3 stored{static_cast<double>(record.mean_normal[0]), static_cast<double>(record.mean_normal[1]),
                       static_cast<double>(record.mean_normal[2])};
  Cone cone;
  if (length(stored) > 0) cone.axis = normalized(stored);
  cone.angle = record.cone_half_angle * kConeUnit;
  cone.cosine = std::cos(cone.angle);
  return cone;
}

class ConeRule {
 public:
  explicit ConeRule(GeometryCheck& check) : check_(check), geometry_(check.geometry()) {}

  void run() {
    CheckContext& context = check_.context;
    nodes_ = check_.nodesOf(-1);
    for (std::uint32_t number = 1; number <= context.records.size(); ++number)
      cones_.push_back(coneOf(context.record(number)));
    check_.has_facets.assign(context.records.size() + 1, 0);
    widest_.assign(context.records.size() + 1, 0.0);
    std::vector<double> steepest(nodes_.size(), 0.0);
    parallelReport(context.report, nodes_.size(), 8, [&](std::size_t item, Report& report) {
      checkNode(nodes_[item], steepest[item], report);
    });
    for (std::size_t i = 0; i < nodes_.size(); ++i) {
      const NodeRecord& record = context.record(nodes_[i]);
      check_.between_posts.addSteepest(record.level, record.x, record.y, steepest[i]);
    }
    checkWidths();
  }

 private:
  void checkNode(std::uint32_t number, double& steepest, Report& report) {
    const NodeRecord& record = check_.context.record(number);
    const TilePointer tile = check_.loader.find(number);
    if (!tile || !tile->hasPosts()) return;
    const std::vector<PostPlace> places = geometry_.postPlaces(record.level, tile->columns, tile->rows);
    const auto width = static_cast<std::size_t>(tile->columns.size());
    std::vector<Vector3> positions(places.size());
    for (std::int64_t row = tile->rows.begin; row < tile->rows.end; ++row) {
      for (std::int64_t column = tile->columns.begin; column < tile->columns.end; ++column) {
        const std::size_t i = static_cast<std::size_t>(row - tile->rows.begin) * width +
                              static_cast<std::size_t>(column - tile->columns.begin);
        positions[i] = places[i].at(geometry_.metres(tile->height(column, row)));
      }
    }
    std::vector<Vector3> normals;
    Vector3 sum;
    const auto facet = [&](std::size_t a, std::size_t b, std::size_t c, std::size_t south_west) {
      const Vector3 normal = cross(positions[b] - positions[a], positions[c] - positions[a]);
      const double size = length(normal);
      if (!(size > 0)) return;
      sum = sum + normal;
      normals.push_back(normal * (1 / size));
      const Vector3& up = places[south_west].up;
      const double rise = dot(normals.back(), up);
      const double slope =
          rise > 0 ? length(cross(normals.back(), up)) / rise : std::numeric_limits<double>::infinity();
      if (slope > steepest && coversGround(places[a].foot, places[b].foot, places[c].foot)) steepest = slope;
    };
    for (std::int64_t row = tile->rows.begin; row + 1 < tile->rows.end; ++row) {
      for (std::int64_t column = tile->columns.begin; column + 1 < tile->columns.end; ++column) {
        if (!tile->isValid(column, row) || !tile->isValid(column + 1, row + 1)) continue;
        const std::size_t sw = static_cast<std::size_t>(row - tile->rows.begin) * width +
                               static_cast<std::size_t>(column - tile->columns.begin);
        if (tile->isValid(column + 1, row)) facet(sw, sw + 1, sw + width + 1, sw);
        if (tile->isValid(column, row + 1)) facet(sw, sw + width + 1, sw + width, sw);
      }
    }
    check_.has_facets[number] = normals.empty() ? 0 : 1;
    if (const auto seam = check_.seam_faces.find(number); seam != check_.seam_faces.end()) {
      for (const auto& [a, b, c] : seam->second) {
        const Vector3 normal = cross(b - a, c - a);
        if (length(normal) > 0) normals.push_back(normalized(normal));
      }
    }
    holdInCones(number, normals, report);
    checkMean(number, record, check_.has_facets[number] == 0 ? Vector3{} : sum, report);
    checkSeams(number, record, *tile, report);
  }

  // The facets in the cone of their node and of every node above it.
  void holdInCones(std::uint32_t number, const std::vector<Vector3>& normals, Report& report) {
    for (std::uint32_t above = number; above != 0; above = check_.context.parents[above - 1]) {
      const Cone& cone = cones_[above - 1];
      double widest = 0, least_cosine = 1;
      for (const Vector3& normal : normals) {
        const double cosine = dot(normal, cone.axis);
        // Where the cosine is far from 1 it orders angles as well as the angle itself.
        if (cosine > least_cosine + 1e-12) continue;
        least_cosine = std::min(least_cosine, cosine);
        widest = std::max(widest, angleBetween(normal, cone.axis));
      }
      if (above == number) widest_[number] = widest;
      if (widest <= cone.angle + kAngleRounding) continue;
      const double outside = (widest - cone.angle) * 180 / std::numbers::pi;
      addLazily(report, IssueCode::kTileCone, outside, [&] {
        return makeIssue(
            IssueCode::kTileCone,
            fmt::format("a facet of node {} lies {:.4f} degrees outside its normal cone", number, outside),
            check_.whereRecord(above), outside);
      });
    }
  }

  void checkMean(std::uint32_t number, const NodeRecord& record, const Vector3& sum, Report& report) {
    const double size = length(sum);
    const Vector3 stored{static_cast<double>(record.mean_normal[0]),
                         static_cast<double>(record.mean_normal[1]),
                         static_cast<double>(record.mean_normal[2])};
    if (!(size > 0)) {
      // Without facets of its own it takes a child's, or has none.
      const double off = std::abs(length(stored) - 32767);
      if (length(stored) == 0 || off <= kNormalUnits) return;
      report.add(makeIssue(IssueCode::kTileNormal, "its mean normal is no unit vector",
                           check_.whereRecord(number), off));
      return;
    }
    const Vector3 off = stored - sum * (32767 / size);
    const double most = std::max({std::abs(off.x), std::abs(off.y), std::abs(off.z)});
    if (most <= kNormalUnits) return;
    const double degrees = angleBetween(stored, sum) * 180 / std::numbers::pi;
    report.add(makeIssue(IssueCode::kTileNormal,
                         fmt::format("its mean normal is {:.4f} degrees off the mean of its facets", degrees),
                         check_.whereRecord(number), degrees));
  }

  // The posts of one line of a tile with their neighbours, as a tile of its own.
  static TerrainTile strip(const NodeRecord& record, const LoadedTile& tile, PostRange columns,
                           PostRange rows) {
    TerrainTile result;
    result.grid = record.grid;
    result.level = record.level;
    result.first_column = columns.begin;
    result.first_row = rows.begin;
    result.columns = static_cast<int>(columns.size());
    result.rows = static_cast<int>(rows.size());
    for (std::int64_t row = rows.begin - 1; row <= rows.end; ++row) {
      for (std::int64_t column = columns.begin - 1; column <= columns.end; ++column) {
        result.heights.push_back(tile.height(column, row));
        result.valid.push_back(tile.isValid(column, row) ? 1 : 0);
      }
    }
    return result;
  }

  void checkSeams(std::uint32_t number, const NodeRecord& record, const LoadedTile& tile, Report& report) {
    const std::int64_t leaf = geometry_.header().leaf_cells;
    const auto compare = [&](std::int64_t dx, std::int64_t dy, PostRange columns, PostRange rows) {
      const std::uint32_t other =
          check_.context.recordAt({record.grid, record.level, static_cast<std::int32_t>(record.x + dx),
                                   static_cast<std::int32_t>(record.y + dy)});
      const TilePointer neighbour = check_.loader.find(other);
      if (!neighbour || !neighbour->hasPosts()) return;
      const std::vector<Vector3> here = vertexNormals(strip(record, tile, columns, rows), geometry_);
      const std::vector<Vector3> there = vertexNormals(strip(record, *neighbour, columns, rows), geometry_);
      for (std::size_t i = 0; i < here.size(); ++i) {
        if (here[i] == there[i]) continue;
        report.add(makeIssue(
            IssueCode::kTileNormal,
            fmt::format("a vertex normal on the border with node {} differs from that node's", other),
            check_.whereRecord(number), angleBetween(here[i], there[i]) * 180 / std::numbers::pi));
        return;
      }
    };
    const std::int64_t east = (std::int64_t{record.x} + 1) * leaf,
                       north = (std::int64_t{record.y} + 1) * leaf;
    if (east < tile.columns.end) compare(1, 0, {east, east + 1}, tile.rows);
    if (north < tile.rows.end) compare(0, 1, tile.columns, {north, north + 1});
  }

  // A cone needs to hold the node's own facets and its children's cones, and no more.
  void checkWidths() {
    CheckContext& context = check_.context;
    for (std::uint32_t number = 1; number <= context.records.size(); ++number) {
      const NodeRecord& record = context.record(number);
      // The area's own cone is over all grids: the last of them looks at it.
      const bool ours =
          number == 1 ? check_.grid + std::size_t{1} == context.grids.size() : record.grid == check_.grid;
      if (!ours) continue;
      double needed = widest_[number];
      for (std::uint32_t child = record.first_child; child != 0; child = context.record(child).sibling) {
        const NodeRecord& below = context.record(child);
        const bool no_cone = below.mean_normal == std::array<std::int16_t, 3>{};
        if (!no_cone)
          needed = std::max(needed, angleBetween(cones_[number - 1].axis, cones_[child - 1].axis) +
                                        cones_[child - 1].angle);
      }
      const double excess = cones_[number - 1].angle - needed;
      if (excess <= kConeUnits * kConeUnit) continue;
      context.report.add(
          makeIssue(IssueCode::kTileCone,
                    fmt::format("its normal cone is {:.4f} degrees wider than what is below it needs",
                                excess * 180 / std::numbers::pi),
                    check_.whereRecord(number), excess * 180 / std::numbers::pi));
    }
  }

  GeometryCheck& check_;
  const GridGeometry& geometry_;
  std::vector<std::uint32_t> nodes_;
  std::vector<Cone> cones_;     // by record number - 1
  std::vector<double> widest_;  // of the node's own facets against its axis, by record number, radians
};

}  // namespace

void checkCones(GeometryCheck& check) {
  ConeRule(check).run();
}

}  // namespace deltaz
