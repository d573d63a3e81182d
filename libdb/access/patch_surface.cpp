#include "libdb/access/patch_surface.h"

#include <algorithm>
#include <array>
#include <cstddef>

#include "libdb/access/grid_geometry.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "libdb/access/patch_surface.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#ifndef DELTAZ_PATCH_POINTS
#define DELTAZ_PATCH_POINTS
namespace deltaz {
namespace {

constexpr std::size_t kPoints = kPatchDegree + 1;

}  // namespace
}  // namespace deltaz
#endif

HWY_BEFORE_NAMESPACE();
namespace deltaz {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;
namespace {

// A run of posts between the same control points, in the order of `weighted` below. Whole vectors are
// written.
void weightedRun(const std::array<Vector3, kPoints>& points,
                 const std::array<std::vector<double>, kPoints>& weights, std::size_t begin, std::size_t end,
                 double* x, double* y, double* z) {
  const hn::ScalableTag<double> d;
  for (std::size_t i = begin; i < end; i += hn::Lanes(d)) {
    const auto first = hn::LoadU(d, &weights[0][i]);
    auto sum_x = hn::Mul(hn::Set(d, points[0].x), first);
    auto sum_y = hn::Mul(hn::Set(d, points[0].y), first);
    auto sum_z = hn::Mul(hn::Set(d, points[0].z), first);
    for (std::size_t k = 1; k < kPoints; ++k) {
      const auto weight = hn::LoadU(d, &weights[k][i]);
      sum_x = hn::Add(sum_x, hn::Mul(hn::Set(d, points[k].x), weight));
      sum_y = hn::Add(sum_y, hn::Mul(hn::Set(d, points[k].y), weight));
      sum_z = hn::Add(sum_z, hn::Mul(hn::Set(d, points[k].z), weight));
    }
    hn::StoreU(sum_x, d, x + i);
    hn::StoreU(sum_y, d, y + i);
    hn::StoreU(sum_z, d, z + i);
  }
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace deltaz
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace deltaz {
namespace {

HWY_EXPORT(weightedRun);

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

void patchPositions(const PatchLattice& lattice, std::int64_t first_column, std::int64_t columns,
                    std::int64_t first_row, std::int64_t rows, std::int64_t step, VectorLists& positions) {
  const PatchPlacement& placement = lattice.placement;
  // Columns between the same control points follow each other.
  struct Run {
    std::int64_t first_point = 0;
    std::size_t begin = 0, end = 0;
  };
  thread_local std::vector<Run> runs;
  thread_local std::array<std::vector<double>, kPoints> weights;
  const auto width = static_cast<std::size_t>(columns);
  runs.clear();
  for (std::vector<double>& list : weights) resizePadded(list, width);
  for (std::size_t i = 0; i < width; ++i) {
    const Weights x = weightsAt(first_column + static_cast<std::int64_t>(i) * step, placement.first_x,
                                placement.columns, placement.cells);
    for (std::size_t k = 0; k < kPoints; ++k) weights[k][i] = x.weight[k];
    if (runs.empty() || runs.back().first_point != x.first_point) runs.push_back({x.first_point, i, i});
    runs.back().end = i + 1;
  }
  const std::size_t count = width * static_cast<std::size_t>(rows);
  positions.resize(count);
  for (std::int64_t j = 0; j < rows; ++j) {
    const Weights y = weightsAt(first_row + j * step, placement.first_y, placement.rows, placement.cells);
    const std::size_t row = static_cast<std::size_t>(j) * width;
    // A vector beyond a run's end is overwritten by the next run, the next row or the padding.
    for (const Run& run : runs) {
      HWY_DYNAMIC_DISPATCH(weightedRun)
      (reduceRows(lattice, run.first_point, y), weights, run.begin, run.end, positions.x.data() + row,
       positions.y.data() + row, positions.z.data() + row);
    }
  }
  positions.resize(count);
}

}  // namespace deltaz
#endif
