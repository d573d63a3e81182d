// The surfaces between the posts of grids, wherever they lie: bilinear heights at positions of any reference
// system, and how far one surface lies from the posts of others. Thread-safety: const members from one thread
// at a time.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "libdb/source/elevation_source.h"
#include "libdb/source/reference_system.h"

namespace deltaz {

// A position this far from a post (in posts) is on it.
inline constexpr double kOnPost = 1e-9;

// The surface between a grid's posts, over positions counted in posts from its first one.
class GridSurface {
 public:
  explicit GridSurface(const RawGrid& grid) : grid_(grid), quantum_(grid.header.quantum.value()) {}
  // Metres; nothing outside and where a post that counts is void.
  std::optional<double> heightAt(double x, double y) const;

 private:
  const RawGrid& grid_;
  double quantum_;
};

// A grid's axes, and how coordinates of its system become positions in posts.
class GridLattice {
 public:
  GridLattice(const GridHeader& header, const ReferenceSystem& system);
  double xAt(std::int64_t column) const;
  double yAt(std::int64_t row) const;
  double column(double x) const;
  double row(double y) const { return (y - south_) / header_.y_axis.spacing; }

 private:
  const GridHeader& header_;
  bool geographic_;
  AxisOrigin of_x_ = kProjectedOrigin, of_y_ = kProjectedOrigin;
  double west_ = 0, south_ = 0, middle_ = 0;
};

// A grid and what its axes refer to.
struct PlacedGrid {
  const RawGrid* grid = nullptr;
  ReferenceSystem system;
  std::string path;  // for messages
};

// Surfaces one above the other, seen from one reference system.
class SurfaceStack {
 public:
  // Errors as CoordinateChange::between.
  static Result<SurfaceStack> make(std::span<const PlacedGrid> grids, const ReferenceSystem& seen_from,
                                   bool allow_ballpark);
  // Heights in metres, of the first of the `count` uppermost grids that has one; NaN where there is none.
  std::vector<double> heightsAt(std::span<const double> x, std::span<const double> y,
                                std::size_t count) const;
  std::size_t size() const { return grids_.size(); }

 private:
  SurfaceStack() = default;
  std::vector<PlacedGrid> grids_;
  std::vector<CoordinateChange> changes_;
};

struct SurfaceDifference {
  double largest = 0, rms = 0;  // metres
  std::uint64_t posts = 0;      // compared
};

// The surface of `made` against the posts of the grids it was made from, the uppermost first, where those are
// not covered by one above.
Result<SurfaceDifference> differenceFrom(const RawGrid& made, const ReferenceSystem& system,
                                         std::span<const PlacedGrid> grids, bool allow_ballpark);

}  // namespace deltaz
