#include "libdb/access/patch_surface.h"

#include <algorithm>
#include <array>
#include <cstddef>

#include "libdb/access/grid_geometry.h"

namespace deltaz {

namespace {

constexpr std::size_t kPoints = kPatchDegree + 1;

// Which control points an index is interpolated from, and with what weights.
struct Weights {
  std::int64_t first_point = 0;
  std::array<double, kPoints> weight{};
};

Weights weightsAt(std::int64_t index, std::int64_t first_patch, std::int64_t patches, std::int64_t cells) {
  const std::int64_t patch = std::clamp(floorDivide(index, cells), first_patch, first_patch + patches - 1);
  Weights result;
  result.first_point = (patch - first_patch) * kPatchDegree;
  // In units of control points; exact, since cells / degree is a power of two.
  const double u = static_cast<double>(index - patch * cells) * kPatchDegree / static_cast<double>(cells);
  for (std::size_t k = 0; k < kPoints; ++k) {
    double numerator = 1, denominator = 1;
    for (std::size_t other = 0; other < kPoints; ++other) {
      if (other == k) continue;
      numerator *= u - static_cast<double>(other);
      denominator *= static_cast<double>(k) - static_cast<double>(other);
    }
    result.weight[k] = numerator / denominator;
  }
  return result;
}

Vector3 controlPoint(const PatchLattice& lattice, std::int64_t column, std::int64_t row) {
  const auto at = static_cast<std::size_t>((row * lattice.pointColumns() + column) * 3);
  return {lattice.controls[at], lattice.controls[at + 1], lattice.controls[at + 2]};
}

// The sum in a fixed order, so that equal terms give equal bits.
Vector3 weighted(const std::array<Vector3, kPoints>& points, const std::array<double, kPoints>& weight) {
  Vector3 sum = points[0] * weight[0];
  for (std::size_t k = 1; k < kPoints; ++k) sum = sum + points[k] * weight[k];
  return sum;
}

std::array<Vector3, kPoints> reduceRows(const PatchLattice& lattice, std::int64_t first_column,
                                        const Weights& y) {
  std::array<Vector3, kPoints> reduced;
  for (std::size_t i = 0; i < kPoints; ++i) {
    std::array<Vector3, kPoints> column;
    for (std::size_t j = 0; j < kPoints; ++j) {
      column[j] = controlPoint(lattice, first_column + static_cast<std::int64_t>(i),
                               y.first_point + static_cast<std::int64_t>(j));
    }
    reduced[i] = weighted(column, y.weight);
  }
  return reduced;
}

}  // namespace

Vector3 patchPosition(const PatchLattice& lattice, std::int64_t column, std::int64_t row) {
  return patchPositions(lattice, column, 1, row, 1, 1).front();
}

std::vector<Vector3> patchPositions(const PatchLattice& lattice, std::int64_t first_column,
                                    std::int64_t columns, std::int64_t first_row, std::int64_t rows,
                                    std::int64_t step) {
  const PatchPlacement& placement = lattice.placement;
  std::vector<Weights> x;
  x.reserve(static_cast<std::size_t>(columns));
  for (std::int64_t i = 0; i < columns; ++i)
    x.push_back(weightsAt(first_column + i * step, placement.first_x, placement.columns, placement.cells));
  std::vector<Vector3> positions;
  positions.reserve(static_cast<std::size_t>(columns * rows));
  for (std::int64_t j = 0; j < rows; ++j) {
    const Weights y = weightsAt(first_row + j * step, placement.first_y, placement.rows, placement.cells);
    std::array<Vector3, kPoints> reduced;
    std::int64_t reduced_first = -1;
    for (const Weights& of_column : x) {
      if (of_column.first_point != reduced_first) {
        reduced_first = of_column.first_point;
        reduced = reduceRows(lattice, reduced_first, y);
      }
      positions.push_back(weighted(reduced, of_column.weight));
    }
  }
  return positions;
}

}  // namespace deltaz
