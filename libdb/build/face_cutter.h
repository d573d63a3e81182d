// Cuts one face of a grid's cell along lines inside it: constrained Delaunay triangulation in the cell's own
// coordinates. The only file that knows CGAL. Internal to libdb/build. Thread-safety: pure function.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace deltaz {

struct CutPoint {
  double x = 0, y = 0;       // in the cell, 0 .. 1
  std::uint32_t number = 0;  // the caller's
};

// Which side of the lines a part lies on: to the left of them is inside.
enum class CutPart : std::uint8_t { kInside, kOutside, kUndecided };

struct CutTriangle {
  std::array<std::uint32_t, 3> corners{};  // counter-clockwise
  CutPart part = CutPart::kUndecided;      // undecided where no line borders the part
};

// `border`: the face's corners and the points on its edges, counter-clockwise. `inner`: points inside it.
// `lines`: directed pairs of numbers that meet at their ends only; nothing if two of them cross.
std::optional<std::vector<CutTriangle>> cutFace(std::span<const CutPoint> border,
                                                std::span<const CutPoint> inner,
                                                std::span<const std::array<std::uint32_t, 2>> lines);

}  // namespace deltaz
