#include "librender/scene/strip_error.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace deltaz {
namespace {

// The steepest slope the normals below a node can have: the angle of the cone's axis against the vertical of
// the node's middle, and the cone.
double steepestSlope(const Node& node) {
  const auto& packed = node.record.mean_normal;
  const Vector3 axis{static_cast<double>(packed[0]), static_cast<double>(packed[1]),
                     static_cast<double>(packed[2])};
  if (!(length(axis) > 0)) return std::numeric_limits<double>::infinity();
  // Geocentric instead of geodetic, and the middle's vertical for all of the node: a degree more than both.
  const Vector3 up = node.centroid;
  const double tilt = std::atan2(length(cross(axis, up)), dot(axis, up));
  const double angle = tilt + node.record.cone_half_angle * (std::numbers::pi / 65535.0) + 0.0175;
  return angle < std::numbers::pi / 2 ? std::tan(angle) : std::numeric_limits<double>::infinity();
}

}  // namespace

StripErrors::StripErrors(const Database& database, const std::vector<CutNode>& nodes, const CutIndex& index)
    : database_(database), nodes_(nodes), index_(index) {}

double StripErrors::bow(const NodeRecord& record) const {
  const GridGeometry& geometry = database_.grid(record.grid);
  const auto found = bows_.try_emplace(record.grid, geometry).first;
  const std::int64_t span = geometry.header().leaf_cells * (std::int64_t{1} << record.level);
  const PostRange all = geometry.rowsAt(0);
  return found->second.at(record.level, {std::max(all.begin, record.y * span),
                                         std::min(all.end, (std::int64_t{record.y} + 1) * span + 1)});
}

double StripErrors::displacement(std::uint16_t grid, std::int64_t column, std::int64_t row, int depth,
                                 std::vector<std::uint32_t>* touched) const {
  // Coarser and coarser nodes touch the ends of edges, so this ends; a damaged tree must not make it go on.
  if (depth > 32) return std::numeric_limits<double>::infinity();
  std::uint32_t coarsest = CutIndex::kNone;
  for (int quadrant = 0; quadrant < 4; ++quadrant) {
    const std::uint32_t node = index_.holding(grid, column - (quadrant & 1), row - ((quadrant >> 1) & 1));
    if (node == CutIndex::kNone) continue;
    if (touched != nullptr) touched->push_back(node);
    if (!nodes_[node].in_view) continue;
    const NodeRecord& record = nodes_[node].node.record;
    const std::int64_t mask = (std::int64_t{1} << record.level) - 1;
    if ((column & mask) == 0 && (row & mask) == 0) continue;
    if (coarsest == CutIndex::kNone || record.level > nodes_[coarsest].node.record.level) coarsest = node;
  }
  if (coarsest == CutIndex::kNone) return 0;
  const Node& node = nodes_[coarsest].node;
  const std::int64_t step = std::int64_t{1} << node.record.level, mask = step - 1;
  // The edge runs along the axis on which the post is none of the node's.
  const bool along_x = (column & mask) != 0;
  const std::int64_t begin = floorDivide(along_x ? column : row, step) * step;
  const auto end_displacement = [&](std::int64_t at) {
    return along_x ? displacement(grid, at, row, depth + 1, touched)
                   : displacement(grid, column, at, depth + 1, touched);
  };
  return node.geometricError() + std::max(end_displacement(begin), end_displacement(begin + step));
}

double StripErrors::strip(std::uint32_t node, std::uint32_t& worst,
                          std::vector<std::uint32_t>* touched) const {
  const NodeRecord& record = nodes_[node].node.record;
  const NodePosition position = positionOf(record);
  const std::int64_t step = std::int64_t{1} << record.level;
  const std::int64_t span = database_.grid(record.grid).header().leaf_cells * step;
  const std::int64_t west = record.x * span, south = record.y * span;
  double largest = 0;
  worst = CutIndex::kNone;
  if (touched != nullptr) touched->clear();
  for (const Side side : kSides) {
    const std::uint32_t across = index_.acrossWhole(position, side);
    if (across == CutIndex::kNone) continue;
    if (touched != nullptr) touched->push_back(across);
    if (!nodes_[across].in_view) continue;
    const Node& coarse = nodes_[across].node;
    if (coarse.record.level <= record.level) continue;
    const bool along_x = side == Side::kSouth || side == Side::kNorth;
    const std::int64_t coarse_step = std::int64_t{1} << coarse.record.level;
    const std::int64_t from = along_x ? west : south;
    const std::int64_t line = side == Side::kSouth   ? south
                              : side == Side::kNorth ? south + span
                              : side == Side::kWest  ? west
                                                     : west + span;
    // Of the coarse edges along this side only the outer ends can be moved by others.
    double of_ends = 0;
    for (const std::int64_t end :
         {floorDivide(from, coarse_step) * coarse_step, ceilDivide(from + span, coarse_step) * coarse_step}) {
      of_ends = std::max(of_ends, along_x ? displacement(record.grid, end, line, 0, touched)
                                          : displacement(record.grid, line, end, 0, touched));
    }
    const double moved = coarse.geometricError() + of_ends;
    // Sideways moves tilt: by the steepest slope of the node, and by what the strip itself leans.
    const double cell = length(database_.grid(record.grid).placeAt(west, south).foot -
                               database_.grid(record.grid).placeAt(west, south + step).foot);
    const double sideways = bow(coarse.record);
    const double tilted = sideways > 0 ? sideways * (steepestSlope(nodes_[node].node) + moved / cell) : 0;
    if (const double sum = moved + tilted; sum > largest || worst == CutIndex::kNone) {
      largest = sum;
      worst = across;
    }
  }
  return largest;
}

}  // namespace deltaz
