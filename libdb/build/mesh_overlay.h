// Which triangles of a mesh lie over a flat triangle, seen along its normal, and over which part of it each.
// Source: none; that the parts leave no gap follows from the mesh going on across every edge met.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "libdb/access/vector3.h"
#include "libdb/build/triangle_view.h"

namespace deltaz {

// What of a piece lies under one triangle: a convex polygon in the piece's plane.
struct OverlayPart {
  std::size_t triangle = 0;
  std::vector<Vector3> polygon;
};

// Not for several threads at once. Memory: 16 bytes a triangle. The view's memory must outlive it.
class MeshOverlay {
 public:
  explicit MeshOverlay(const TriangleView& mesh);

  // The parts cover the piece wholly, up to rounding. None if that cannot be shown: if the mesh ends,
  // branches or turns over within what it covers of the piece, or `first` lies over none of it. Time: of the
  // triangles met, visited() of them.
  std::vector<OverlayPart> over(const std::array<Vector3, 3>& piece, std::size_t first);
  std::size_t visited() const { return waiting_.size(); }

 private:
  static constexpr std::uint32_t kNone = 0xFFFFFFFF;

  TriangleView mesh_;
  // Across the edge from corner k to the next: the one other triangle, or kNone if there is not just one.
  std::vector<std::array<std::uint32_t, 3>> neighbours_;
  std::vector<std::uint32_t> round_of_;  // in which call a triangle was met last
  std::uint32_t round_ = 0;
  std::vector<std::uint32_t> waiting_;
};

}  // namespace deltaz
