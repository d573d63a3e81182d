// The valid pixels of a triangle by Table 5's definition, pixel by pixel over the box, in exact integers and
// from the variables alone.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdlib>
#include <utility>
#include <vector>

#include "librender/ars/words/triangle_variables.h"

namespace deltaz::ars {

using PixelAddress = std::pair<int, int>;  // i, j

// In the order of tiling: lines from the corner's, pixels from the corner's. `fraction` is that of the
// vertices.
inline std::vector<PixelAddress> bruteForcePixels(const TriangleVariables& t, int fraction) {
  const auto round = [&](std::int64_t x) {
    return fraction == 0 ? x : (x + (std::int64_t{1} << (fraction - 1))) >> fraction;
  };
  const std::array<std::int64_t, 3> ri{t.vertices[0].i, t.vertices[1].i, t.vertices[2].i},
      rj{t.vertices[0].j, t.vertices[1].j, t.vertices[2].j};
  const auto [i_min, i_max] = std::minmax({ri[0], ri[1], ri[2]});
  const auto [j_min, j_max] = std::minmax({rj[0], rj[1], rj[2]});
  const bool down = t.corner == Corner::kUpperLeft || t.corner == Corner::kUpperRight;
  const bool rightwards = t.corner == Corner::kUpperLeft || t.corner == Corner::kLowerLeft;
  const std::int64_t i_start = round(down ? i_min : i_max), i_stop = round(down ? i_max : i_min);
  const std::int64_t j_start = round(rightwards ? j_min : j_max), j_stop = round(rightwards ? j_max : j_min);
  const std::int64_t one = std::int64_t{1} << fraction;

  // P_k = (i - i_k)(j_m - j_k) + (j - j_k)(i_k - i_m) for the edge from k to m, twice as large, so that
  // halves of a product's unit are whole.
  const std::array<std::array<std::size_t, 2>, 3> edges{{{0, 2}, {1, 0}, {2, 1}}};
  const std::int64_t area = (ri[1] - ri[0]) * (rj[2] - rj[0]) + (rj[1] - rj[0]) * (ri[0] - ri[2]);
  std::array<std::int64_t, 3> at{}, ni{}, nj{};
  for (std::size_t e = 0; e < 3; ++e) {
    const auto [k, m] = edges[e];
    const std::int64_t sign = area < 0 ? -1 : 1;
    ni[e] = sign * (rj[m] - rj[k]);
    nj[e] = sign * (ri[k] - ri[m]);
    const std::int64_t n_i = std::abs(ni[e]), n_j = std::abs(nj[e]);
    const std::int64_t tolerance =
        t.oversample ? std::max(n_i, n_j) * one
                     : n_i + n_j + 2 * (std::abs(i_start * one - ri[k]) + std::abs(j_start * one - rj[k]));
    at[e] = -2 * (ri[k] * ni[e] + rj[k] * nj[e]) + tolerance;
  }
  std::vector<PixelAddress> pixels;
  const std::int64_t i_step = down ? 1 : -1, j_step = rightwards ? 1 : -1;
  for (std::int64_t i = i_start; i != i_stop + i_step; i += i_step) {
    for (std::int64_t j = j_start; j != j_stop + j_step; j += j_step) {
      bool valid = true;
      for (std::size_t e = 0; e < 3; ++e) valid = valid && at[e] + 2 * one * (i * ni[e] + j * nj[e]) >= 0;
      if (valid) pixels.emplace_back(static_cast<int>(i), static_cast<int>(j));
    }
  }
  return pixels;
}

}  // namespace deltaz::ars
