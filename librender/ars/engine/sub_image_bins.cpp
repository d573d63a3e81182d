#include "librender/ars/engine/sub_image_bins.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numeric>

#include "librender/ars/words/pixel_packet.h"
#include "librender/ars/words/triangle_stream.h"
#include "librender/scene/view_volume.h"

namespace deltaz::ars {

namespace {

// The pretiler places a sub-image's axis first and adds to it: its corners are these, rounded otherwise by
// far less than this many pixels.
constexpr double kMargin = 1;

// Sub-images along one axis of the picture, from first to last; none if first > last.
struct Range {
  int first = 0, last = -1;
};

// Those of `count`, `size` samples each, that [least, greatest] may reach.
Range reached(double least, double greatest, int size, int count) {
  const auto at = [&](double place) {
    return static_cast<int>(std::clamp(std::floor(place / size), -1.0, static_cast<double>(count)));
  };
  return {std::max(at(least - kMargin), 0), std::min(at(greatest + kMargin), count - 1)};
}

bool isFinite(const ViewVertex& vertex) {
  return std::isfinite(vertex.u) && std::isfinite(vertex.v) && std::isfinite(vertex.w) &&
         std::all_of(vertex.color.begin(), vertex.color.end(), [](double c) { return std::isfinite(c); });
}

}  // namespace

SubImageBins binTriangles(const std::vector<ViewTriangle>& triangles, const ViewTransform& view) {
  const auto sub_images = static_cast<std::size_t>(subImageCount(view.width, view.height));
  const int across = (view.width + kScreenPixels - 1) / kScreenPixels;
  const int down = static_cast<int>(sub_images) / across;
  SubImageBins bins;
  bins.triangles.resize(sub_images);
  if (sub_images == 1) {
    bins.triangles[0].resize(triangles.size());
    std::iota(bins.triangles[0].begin(), bins.triangles[0].end(), 0U);
    return bins;
  }
  const auto leave_out = [&bins](std::uint64_t times, std::uint64_t PretilerCounts::*fate) {
    bins.left_out.in += times;
    bins.left_out.*fate += times;
  };
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    const std::array<ViewVertex, 3>& vertex = triangles[t].vertex;
    if (!std::all_of(vertex.begin(), vertex.end(), isFinite)) {
      leave_out(sub_images, &PretilerCounts::edge_on);
      continue;
    }
    const auto [nearest, farthest] = std::minmax({vertex[0].u, vertex[1].u, vertex[2].u});
    if (farthest < kHither) {
      leave_out(sub_images, &PretilerCounts::before_hither);
      continue;
    }
    // The few that the hither plane cuts may reach anywhere.
    Range lines{0, down - 1}, pixels{0, across - 1};
    if (nearest >= kHither) {
      std::array<double, 3> i{}, j{};
      for (std::size_t k = 0; k < 3; ++k) {
        i[k] = view.centre_i + vertex[k].w / vertex[k].u;
        j[k] = view.centre_j + vertex[k].v / vertex[k].u;
      }
      lines = reached(std::min({i[0], i[1], i[2]}), std::max({i[0], i[1], i[2]}), kScreenLines, down);
      pixels = reached(std::min({j[0], j[1], j[2]}), std::max({j[0], j[1], j[2]}), kScreenPixels, across);
    }
    std::uint64_t shown = 0;
    for (int line = lines.first; line <= lines.last; ++line) {
      for (int pixel = pixels.first; pixel <= pixels.last; ++pixel) {
        bins.triangles[static_cast<std::size_t>(line) * static_cast<std::size_t>(across) +
                       static_cast<std::size_t>(pixel)]
            .push_back(static_cast<std::uint32_t>(t));
        ++shown;
      }
    }
    leave_out(sub_images - shown, &PretilerCounts::beside);
  }
  return bins;
}

}  // namespace deltaz::ars
