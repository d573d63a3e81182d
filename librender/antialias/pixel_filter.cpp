#include "librender/antialias/pixel_filter.h"

#include <algorithm>

namespace deltaz {
namespace {

std::size_t offsetIndex(int reach, int dj, int di) {
  return static_cast<std::size_t>((di + reach) * (2 * reach + 1) + dj + reach);
}

}  // namespace

PixelFilter::PixelFilter(const Sampling& sampling)
    : kernel_(sampling), groups_((static_cast<std::size_t>(sampling.count) + 3) / 4) {
  const int reach = kernel_.reach();
  for (int di = -reach; di <= reach; ++di) {
    for (int dj = -reach; dj <= reach; ++dj) {
      const double share = kernel_.weightOfAll(dj, di) / sampling.count;
      for (std::size_t group = 0; group < groups_; ++group) {
        for (std::uint32_t subset = 0; subset < kSubsets; ++subset) {
          double excess = 0;
          for (int s = 0; s < std::min(4, sampling.count); ++s) {
            if ((subset >> s & 1) != 0)
              excess += kernel_.weight(dj, di, static_cast<int>(4 * group) + s) - share;
          }
          excess_.push_back(static_cast<float>(excess));
        }
      }
    }
  }
}

void PixelFilter::filterRow(const MeanColors& colors, int i,
                            const std::array<std::span<float>, 3>& row) const {
  for (const std::span<float>& channel : row) std::fill(channel.begin(), channel.end(), 0.0F);
  const int reach = kernel_.reach(), width = colors.width;
  for (int di = std::max(-reach, -i); di <= std::min(reach, colors.height - 1 - i); ++di) {
    const std::size_t first = static_cast<std::size_t>(i + di) * static_cast<std::size_t>(width);
    for (int dj = -reach; dj <= reach; ++dj) {
      const auto weight = static_cast<float>(kernel_.weightOfAll(dj, di));
      const int from = std::max(0, -dj), to = std::min(width, width - dj);
      if (from >= to) continue;
      for (std::size_t c = 0; c < 3; ++c) {
        const float* const mean = colors.planes[c].data() + first + static_cast<std::size_t>(from + dj);
        float* const sum = row[c].data() + from;
        for (int n = 0; n < to - from; ++n) sum[n] += weight * mean[n];
      }
    }
    addMixed(colors, di, colors.mixed[static_cast<std::size_t>(i + di)], row);
  }
  // Only near the picture's border is the sum another than in its middle.
  const double inside = kernel_.sum(reach, reach, 2 * reach + 1, 2 * reach + 1);
  const bool near_border = i < reach || i >= colors.height - reach;
  for (int j = 0; j < width; ++j) {
    const bool cut = near_border || j < reach || j >= width - reach;
    const auto scale = static_cast<float>(1 / (cut ? kernel_.sum(j, i, width, colors.height) : inside));
    for (std::size_t c = 0; c < 3; ++c) row[c][static_cast<std::size_t>(j)] *= scale;
  }
}

void PixelFilter::addMixed(const MeanColors& colors, int di, std::span<const MixedFragment> fragments,
                           const std::array<std::span<float>, 3>& row) const {
  const int reach = kernel_.reach();
  for (const MixedFragment& fragment : fragments) {
    for (int dj = std::max(-reach, fragment.j - (colors.width - 1)); dj <= std::min(reach, fragment.j);
         ++dj) {
      const float* const excess = excess_.data() + offsetIndex(reach, dj, di) * groups_ * kSubsets;
      float weight = 0;
      for (std::size_t group = 0; group < groups_; ++group)
        weight += excess[group * kSubsets + (fragment.samples >> (4 * group) & (kSubsets - 1))];
      const auto j = static_cast<std::size_t>(fragment.j - dj);
      for (std::size_t c = 0; c < 3; ++c) row[c][j] += weight * fragment.color[c];
    }
  }
}

}  // namespace deltaz
