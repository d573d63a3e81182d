#include "librender/ars/tiler/triangle_encoder.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "librender/ars/words/pixel_packet.h"

namespace deltaz::ars {

namespace {

// A vertex in the machine's numbers and which it was.
struct RoundedVertex {
  TriangleVariables::Vertex position;
  std::size_t original = 0;
};

std::int32_t roundedCoordinate(double x, const FixedPointFormat& format) {
  const std::int64_t half = format.one() / 2, limit = kScreenPixels * format.one();
  return static_cast<std::int32_t>(std::clamp(format.nearest(x), -half, limit - half - 1));
}

std::array<RoundedVertex, 3> roundedVertices(const ProjectedTriangle& triangle,
                                             const FixedPointFormat& format) {
  std::array<RoundedVertex, 3> rounded{};
  for (std::size_t k = 0; k < 3; ++k) {
    rounded[k] = {.position = {.i = roundedCoordinate(triangle[k].i, format),
                               .j = roundedCoordinate(triangle[k].j, format)},
                  .original = k};
  }
  std::stable_sort(rounded.begin(), rounded.end(), [](const RoundedVertex& a, const RoundedVertex& b) {
    return a.position.i < b.position.i;
  });
  return rounded;
}

struct CornerVertex {
  Corner corner = Corner::kUpperLeft;
  std::size_t vertex = 0;
};

// Of three vertices one lies on two neighbouring sides of their box.
CornerVertex findCorner(const std::array<RoundedVertex, 3>& v) {
  const auto [least, greatest] = std::minmax({v[0].position.j, v[1].position.j, v[2].position.j});
  for (const Corner corner :
       {Corner::kUpperLeft, Corner::kUpperRight, Corner::kLowerLeft, Corner::kLowerRight}) {
    const TriangleVariables::Vertex wanted{.i = isLower(corner) ? v[2].position.i : v[0].position.i,
                                           .j = isRight(corner) ? greatest : least};
    for (std::size_t k = 0; k < 3; ++k) {
      if (v[k].position == wanted) return {corner, k};
    }
  }
  return {};
}

// Solves for the gradient from the differences of two vertices to the anchor.
class GradientSolver {
 public:
  GradientSolver(const ProjectedTriangle& triangle, std::size_t anchor)
      : a_(triangle[anchor]), b_(triangle[(anchor + 1) % 3]), c_(triangle[(anchor + 2) % 3]) {
    determinant_ = (b_.i - a_.i) * (c_.j - a_.j) - (b_.j - a_.j) * (c_.i - a_.i);
  }
  ScreenPlane plane(double at_a, double at_b, double at_c) const {
    const double to_b = at_b - at_a, to_c = at_c - at_a;
    const double per_i = (to_b * (c_.j - a_.j) - to_c * (b_.j - a_.j)) / determinant_;
    const double per_j = (to_c * (b_.i - a_.i) - to_b * (c_.i - a_.i)) / determinant_;
    const bool sound = std::isfinite(per_i) && std::isfinite(per_j);
    return {.value = at_a, .per_i = sound ? per_i : 0, .per_j = sound ? per_j : 0};
  }
  TrianglePlanes planes() const {
    return {.i = a_.i,
            .j = a_.j,
            .depth = plane(a_.depth, b_.depth, c_.depth),
            .color = plane(a_.color, b_.color, c_.color),
            .color_over_depth = plane(a_.color * a_.depth, b_.color * b_.depth, c_.color * c_.depth)};
  }

 private:
  const ProjectedVertex &a_, &b_, &c_;
  double determinant_ = 0;
};

// The vertices' part of the variables.
std::pair<TriangleVariables, std::size_t> placedTriangle(const ProjectedTriangle& triangle,
                                                         const NumberProfile& numbers,
                                                         const EncodeOptions& options) {
  const std::array<RoundedVertex, 3> rounded = roundedVertices(triangle, numbers.vertexFormat());
  const CornerVertex corner = findCorner(rounded);
  TriangleVariables variables;
  for (std::size_t k = 0; k < 3; ++k) variables.vertices[k] = rounded[k].position;
  variables.corner = corner.corner;
  variables.oversample = options.oversample;
  variables.background = options.background;
  return {variables, rounded[corner.vertex].original};
}

// The planes' part, at the pixel of the corner.
EncodedTriangle withPlanes(TriangleVariables variables, const ProjectedTriangle& triangle,
                           const TrianglePlanes& planes, const NumberProfile& numbers) {
  const auto& v = variables.vertices;
  const auto [least_j, greatest_j] = std::minmax({v[0].j, v[1].j, v[2].j});
  const int fraction = numbers.vertex_fraction_bits;
  const double to_i = nearestPixel(isLower(variables.corner) ? v[2].i : v[0].i, fraction) - planes.i;
  const double to_j = nearestPixel(isRight(variables.corner) ? greatest_j : least_j, fraction) - planes.j;
  const auto rounded = [&](const FloatFormat& format, double x) {
    return format.round(x, numbers.arithmetic);
  };
  const auto at_pixel = [&](const FloatFormat& format, const ScreenPlane& plane) {
    return rounded(format, plane.value + plane.per_i * to_i + plane.per_j * to_j);
  };

  variables.depth = at_pixel(numbers.depth_plane, planes.depth);
  variables.depth_i = rounded(numbers.depth_plane, planes.depth.per_i);
  variables.depth_j = rounded(numbers.depth_plane, planes.depth.per_j);
  variables.color = at_pixel(numbers.color, planes.color);
  variables.color_i = rounded(numbers.color, planes.color.per_i);
  variables.color_j = rounded(numbers.color, planes.color.per_j);

  const auto [least_depth, greatest_depth] =
      std::minmax({triangle[0].depth, triangle[1].depth, triangle[2].depth});
  return {.variables = variables,
          .supplement = {.least_depth = rounded(numbers.depth_plane, least_depth),
                         .greatest_depth = rounded(numbers.depth_plane, greatest_depth),
                         .color_over_depth = at_pixel(numbers.depth_plane, planes.color_over_depth),
                         .color_over_depth_i = rounded(numbers.depth_plane, planes.color_over_depth.per_i),
                         .color_over_depth_j = rounded(numbers.depth_plane, planes.color_over_depth.per_j)}};
}

}  // namespace

TrianglePlanes planesOf(const ProjectedTriangle& triangle, std::size_t anchor) {
  return GradientSolver(triangle, anchor).planes();
}

EncodedTriangle encodeTriangle(const ProjectedTriangle& triangle, const NumberProfile& numbers,
                               const EncodeOptions& options) {
  const auto [variables, corner_vertex] = placedTriangle(triangle, numbers, options);
  return withPlanes(variables, triangle, planesOf(triangle, corner_vertex), numbers);
}

EncodedTriangle encodeTriangle(const ProjectedTriangle& triangle, const TrianglePlanes& planes,
                               const NumberProfile& numbers, const EncodeOptions& options) {
  return withPlanes(placedTriangle(triangle, numbers, options).first, triangle, planes, numbers);
}

ProjectedTriangle projectedCorners(const ScreenTriangle& triangle, int primary) {
  const ScreenPlanes& planes = triangle.planes;
  ProjectedTriangle corners;
  for (std::size_t k = 0; k < 3; ++k) {
    const ScreenPosition at = triangle.corner[k];
    const double di = at.i - planes.anchor.i, dj = at.j - planes.anchor.j;
    corners[k] = {.i = at.i,
                  .j = at.j,
                  .depth = planes.inverse_u.at(di, dj),
                  .color = planes.color[static_cast<std::size_t>(primary)].at(di, dj)};
  }
  return corners;
}

EncodedTriangle encodeTriangle(const ScreenTriangle& triangle, int primary, const NumberProfile& numbers,
                               const EncodeOptions& options) {
  const ScreenPlanes& given = triangle.planes;
  const ProjectedTriangle corners = projectedCorners(triangle, primary);
  TrianglePlanes planes = planesOf(corners, 0);
  // c/U is moved to where the other planes are anchored.
  ScreenPlane over = planes.color_over_depth;
  over.value = over.at(given.anchor.i - planes.i, given.anchor.j - planes.j);
  planes = {.i = given.anchor.i,
            .j = given.anchor.j,
            .depth = given.inverse_u,
            .color = given.color[static_cast<std::size_t>(primary)],
            .color_over_depth = over};
  EncodedTriangle encoded = encodeTriangle(corners, planes, numbers, options);
  encoded.supplement.least_depth = numbers.depth_plane.round(given.least_inverse_u, numbers.arithmetic);
  encoded.supplement.greatest_depth = numbers.depth_plane.round(given.greatest_inverse_u, numbers.arithmetic);
  return encoded;
}

}  // namespace deltaz::ars
