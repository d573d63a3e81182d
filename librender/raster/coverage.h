// Which samples a triangle covers, exactly: vertices snapped to 1/256 pixel, edge functions in 64-bit
// integers, and the top-left rule, so that triangles sharing an edge cover every sample along it exactly
// once.
//
// Samples are the pixel centres, at integer (j, i). The inside of each edge (k, k + 1) is its non-negative
// side with i pointing down, that is, the vertices run clockwise on the screen. A sample on an edge belongs
// to the triangle only if the edge is a left edge (running up) or a top edge (level, running right). Range:
// coordinates within +-2^24 / 256 pixels keep every product below 2^51. Thread-safety: pure functions.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "librender/raster/raster_triangle.h"

namespace deltaz {

struct SnappedTriangle {
  std::array<std::int32_t, 3> x{}, y{};  // 1/256 pixel; x along j, y along i
  std::uint32_t face = 0;                // whose piece it is: index into PretiledNode::faces
};

// Nearest multiple of 1/256 pixel, ties to even.
inline std::int32_t snap(double pixels) {
  return static_cast<std::int32_t>(std::lrint(pixels * kSubPixels));
}

// Twice the area in units of 1/65536 square pixel; positive for triangles that can be tiled.
inline std::int64_t doubledArea(const SnappedTriangle& t) {
  const std::int64_t x1 = t.x[1] - t.x[0], y1 = t.y[1] - t.y[0], x2 = t.x[2] - t.x[0], y2 = t.y[2] - t.y[0];
  return x1 * y2 - x2 * y1;
}

// Inclusive ranges of pixels.
struct SampleBounds {
  std::int32_t first_j = 0, last_j = -1, first_i = 0, last_i = -1;
  bool empty() const { return first_j > last_j || first_i > last_i; }
};

inline SampleBounds intersection(const SampleBounds& a, const SampleBounds& b) {
  return {std::max(a.first_j, b.first_j), std::min(a.last_j, b.last_j), std::max(a.first_i, b.first_i),
          std::min(a.last_i, b.last_i)};
}

// Samples within the triangle's bounding box and the picture.
inline SampleBounds sampleBounds(const SnappedTriangle& t, int width, int height) {
  const auto [least_x, greatest_x] = std::minmax({t.x[0], t.x[1], t.x[2]});
  const auto [least_y, greatest_y] = std::minmax({t.y[0], t.y[1], t.y[2]});
  return intersection({(least_x + kSubPixels - 1) >> kSubPixelBits, greatest_x >> kSubPixelBits,
                       (least_y + kSubPixels - 1) >> kSubPixelBits, greatest_y >> kSubPixelBits},
                      {0, width - 1, 0, height - 1});
}

// Calls visit(j, i) for every covered sample within `bounds`, row by row. Pre: doubledArea(triangle) > 0.
template <typename Visit>
void forEachSample(const SnappedTriangle& triangle, const SampleBounds& bounds, Visit&& visit) {
  if (bounds.empty()) return;
  std::array<std::int64_t, 3> row{}, per_j{}, per_i{};
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t next = k == 2 ? 0 : k + 1;
    const std::int64_t dx = triangle.x[next] - triangle.x[k], dy = triangle.y[next] - triangle.y[k];
    const bool keeps_its_samples = dy < 0 || (dy == 0 && dx > 0);
    per_j[k] = -dy * kSubPixels;
    per_i[k] = dx * kSubPixels;
    // The functions are integers, so "greater than zero" is "at least zero" after subtracting one.
    row[k] = dx * (std::int64_t{bounds.first_i} * kSubPixels - triangle.y[k]) -
             dy * (std::int64_t{bounds.first_j} * kSubPixels - triangle.x[k]) - (keeps_its_samples ? 0 : 1);
  }
  for (std::int32_t i = bounds.first_i; i <= bounds.last_i; ++i) {
    std::int64_t a = row[0], b = row[1], c = row[2];
    bool entered = false;
    for (std::int32_t j = bounds.first_j; j <= bounds.last_j; ++j) {
      if ((a | b | c) >= 0) {
        entered = true;
        visit(j, i);
      } else if (entered) {
        break;  // a row of a triangle has no second part
      }
      a += per_j[0];
      b += per_j[1];
      c += per_j[2];
    }
    for (std::size_t k = 0; k < 3; ++k) row[k] += per_i[k];
  }
}

}  // namespace deltaz
