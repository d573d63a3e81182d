#include "librender/raster/resolver.h"

#include <algorithm>
#include <cstddef>
#include <limits>
#include <tbb/parallel_for.h>

namespace deltaz {
namespace {

// The vertices' colours weighted in perspective; the weights are kept within the face, as the depth is.
LinearColor colorAt(const FacePlanes& face, int j, int i, double u) {
  const double dj = j - face.anchor_j, di = i - face.anchor_i;
  double second = std::clamp(face.weight1.at(dj, di) * u, 0.0, 1.0);
  double third = std::clamp(face.weight2.at(dj, di) * u, 0.0, 1.0);
  const double sum = second + third;
  if (sum > 1) {
    second /= sum;
    third /= sum;
  }
  const double first = std::max(0.0, 1 - second - third);
  const auto channel = [&](std::size_t c) {
    return first * static_cast<double>(face.color[0][c]) + second * static_cast<double>(face.color[1][c]) +
           third * static_cast<double>(face.color[2][c]);
  };
  return {channel(0), channel(1), channel(2)};
}

}  // namespace

ResolverStatistics resolve(const Environment& environment, const std::vector<PretiledNode>& nodes,
                           const DepthFrameBuffer& buffer, Picture& picture) {
  std::vector<ResolverStatistics> of_row(static_cast<std::size_t>(buffer.height()));
  tbb::parallel_for(0, buffer.height(), [&](int i) {
    ResolverStatistics counts;
    for (int j = 0; j < buffer.width(); ++j) {
      const std::size_t pixel = static_cast<std::size_t>(i) * static_cast<std::size_t>(buffer.width()) +
                                static_cast<std::size_t>(j);
      const DepthFrameBuffer::Pixel& nearest = buffer.at(j, i);
      const Vector3 ray = environment.view.ray(j, i);
      const double sea_u = environment.sea.depth(ray);
      if (!nearest.empty()) {
        ++counts.covered;
        const FacePlanes& face = nodes[nearest.node].faces[nearest.face];
        const double u = 1 / face.inverseDepthAt(j, i);
        if (u <= sea_u) {
          ++counts.shaded;
          storePixel(environment, ray, face.surface, u, colorAt(face, j, i, u), pixel, picture);
          if (!picture.triangle.empty()) picture.triangle[pixel] = face.identity;
          continue;
        }
      }
      if (sea_u < std::numeric_limits<double>::infinity()) {
        storePixel(environment, ray, Surface::kSea, sea_u, environment.sea.color(ray, sea_u), pixel, picture);
      } else {
        storePixel(environment, ray, Surface::kSky, sea_u, environment.atmosphere.sky(ray), pixel, picture);
      }
    }
    of_row[static_cast<std::size_t>(i)] = counts;
  });
  ResolverStatistics sum;
  for (const ResolverStatistics& counts : of_row) {
    sum.covered += counts.covered;
    sum.shaded += counts.shaded;
  }
  return sum;
}

}  // namespace deltaz
