#include "libdb/source/patch_fitting.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <fmt/format.h>
#include <limits>
#include <optional>
#include <vector>

#include "libdb/access/earth.h"
#include "libdb/access/grid_geometry.h"
#include "libdb/access/patch_surface.h"
#include "libdb/source/source_error.h"

namespace deltaz {

namespace {

constexpr std::int64_t kSmallestPatch = kPatchDegree;
// Positions between neighbouring control points that the error is measured at, along each axis: their middle
// and quarters, and nothing on a control point, where the error is zero by construction.
constexpr int kSamplesBetween = 3;
constexpr std::int64_t kMostSamples = 4000000;

struct Positions {
  std::vector<double> x, y;  // units of the projection, then degrees
};

class Fitting {
 public:
  Fitting(const GridHeader& header, const CoordinateChange& to_geographic)
      : header_(header), to_geographic_(to_geographic) {}

  // Nothing if a control point has no place.
  std::optional<PatchLattice> latticeOf(std::int64_t cells) const {
    PatchLattice lattice;
    lattice.placement.cells = cells;
    const auto cover = [cells](const GridAxis& axis, std::int64_t& first, std::int64_t& count) {
      first = floorDivide(axis.first, cells);
      count = std::max<std::int64_t>(1, ceilDivide(axis.first + axis.count - 1, cells) - first);
    };
    cover(header_.x_axis, lattice.placement.first_x, lattice.placement.columns);
    cover(header_.y_axis, lattice.placement.first_y, lattice.placement.rows);
    if (lattice.placement.columns > kMaximumPatches / lattice.placement.rows) return std::nullopt;
    Positions positions;
    for (std::int64_t row = 0; row < lattice.pointRows(); ++row) {
      const std::int64_t y = lattice.placement.first_y * cells + row * lattice.step();
      for (std::int64_t column = 0; column < lattice.pointColumns(); ++column) {
        const std::int64_t x = lattice.placement.first_x * cells + column * lattice.step();
        positions.x.push_back(postCoordinate(header_.x_axis, kProjectedOrigin, x));
        positions.y.push_back(postCoordinate(header_.y_axis, kProjectedOrigin, y));
      }
    }
    if (!to_geographic_.apply(positions.x, positions.y)) return std::nullopt;
    lattice.controls.reserve(positions.x.size() * 3);
    for (std::size_t k = 0; k < positions.x.size(); ++k) {
      const Vector3 point = toEarthCentred(header_.ellipsoid, {positions.y[k], positions.x[k], 0});
      lattice.controls.insert(lattice.controls.end(), {point.x, point.y, point.z});
    }
    return lattice;
  }

  // Largest distance, metres, between the lattice and the exact transformation, at posts off the control
  // points and inside the grid; infinity as soon as it passes `limit`.
  double errorOf(const PatchLattice& lattice, double limit) const {
    const std::vector<std::int64_t> columns =
        samplesOf(header_.x_axis, lattice.placement.first_x, lattice.placement.columns, lattice);
    const std::vector<std::int64_t> rows =
        samplesOf(header_.y_axis, lattice.placement.first_y, lattice.placement.rows, lattice);
    const std::int64_t all =
        static_cast<std::int64_t>(columns.size()) * static_cast<std::int64_t>(rows.size());
    // Where that is too much, every n-th row.
    const auto skip = static_cast<std::size_t>(1 + all / kMostSamples);
    double largest = 0;
    for (std::size_t r = 0; r < rows.size(); r += skip) {
      Positions positions;
      for (const std::int64_t column : columns) {
        positions.x.push_back(postCoordinate(header_.x_axis, kProjectedOrigin, column));
        positions.y.push_back(postCoordinate(header_.y_axis, kProjectedOrigin, rows[r]));
      }
      if (!to_geographic_.apply(positions.x, positions.y)) return std::numeric_limits<double>::infinity();
      for (std::size_t k = 0; k < columns.size(); ++k) {
        const Vector3 exact = toEarthCentred(header_.ellipsoid, {positions.y[k], positions.x[k], 0});
        largest = std::max(largest, length(patchPosition(lattice, columns[k], rows[r]) - exact));
      }
      if (largest * kPatchErrorMargin > limit) return std::numeric_limits<double>::infinity();
    }
    return largest * kPatchErrorMargin;
  }

 private:
  // Indices of posts between the control points, as far as they lie in the grid.
  static std::vector<std::int64_t> samplesOf(const GridAxis& axis, std::int64_t first_patch,
                                             std::int64_t patches, const PatchLattice& lattice) {
    const std::int64_t step = lattice.step(), points = patches * kPatchDegree;
    std::vector<std::int64_t> samples;
    const auto add = [&](std::int64_t index) {
      const bool inside = index >= axis.first && index < axis.first + axis.count;
      if (inside && (samples.empty() || samples.back() < index)) samples.push_back(index);
    };
    for (std::int64_t point = 0; point < points; ++point) {
      const std::int64_t begin = first_patch * lattice.placement.cells + point * step;
      for (int k = 1; k <= kSamplesBetween; ++k) {
        // The grid's own first and last post count wherever they are.
        if (begin < axis.first && begin + step > axis.first) add(axis.first);
        const std::int64_t index = begin + step * k / (kSamplesBetween + 1);
        if (index > begin) add(index);
      }
      if (begin < axis.first + axis.count - 1 && begin + step > axis.first + axis.count - 1)
        add(axis.first + axis.count - 1);
    }
    // Patches of one post a control point: every post is exact, and this is a check of the evaluation.
    if (samples.empty()) samples = {axis.first, axis.first + axis.count - 1};
    return samples;
  }

  const GridHeader& header_;
  const CoordinateChange& to_geographic_;
};

}  // namespace

Result<std::shared_ptr<const PatchLattice>> fitPatches(const GridHeader& header,
                                                       const CoordinateChange& to_geographic,
                                                       const std::string& path) {
  const Fitting fitting(header, to_geographic);
  const auto most = static_cast<std::uint64_t>(std::max(header.x_axis.count, header.y_axis.count));
  // From a patch that covers the whole grid downwards.
  std::optional<PatchLattice> acceptable;
  for (auto cells = static_cast<std::int64_t>(std::bit_ceil(std::max<std::uint64_t>(most, kSmallestPatch)));
       cells >= kSmallestPatch; cells /= 2) {
    std::optional<PatchLattice> lattice = fitting.latticeOf(cells);
    if (!lattice) continue;
    lattice->placement.error = fitting.errorOf(*lattice, acceptable ? kPatchErrorAim : kPatchErrorBound);
    if (lattice->placement.error <= kPatchErrorAim) {
      acceptable = std::move(lattice);
      break;
    }
    if (!acceptable && lattice->placement.error <= kPatchErrorBound) acceptable = std::move(lattice);
  }
  if (!acceptable) {
    return refusedSource(
        path, "the source's posts cannot be placed on the Earth accurately",
        "its projection is not smooth there, or does not reach all of them",
        "Check the reference system, or warp the source to geographic coordinates with gdalwarp");
  }
  return std::make_shared<const PatchLattice>(std::move(*acceptable));
}

}  // namespace deltaz
