// Puts the colours of fragments together to pixels where a filter reaches beyond a pixel.
//
// A pixel that shows one thing gives its colour to its neighbours with the weights of all its samples at
// once; of one that shows several, what its fragments weigh otherwise than its mean colour is added. In
// single precision, in a fixed order. Thread-safety: different rows from different threads.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "librender/antialias/filter.h"

namespace deltaz {

// One of several fragments of a pixel.
struct MixedFragment {
  std::int32_t j = 0;  // its pixel's column in the picture
  std::uint64_t samples = 0;
  std::array<float, 3> color{};  // linear
};

// What is seen of a picture before it is filtered, rows from the top.
struct MeanColors {
  MeanColors(int columns, int rows) : width(columns), height(rows), mixed(static_cast<std::size_t>(rows)) {
    for (std::vector<float>& plane : planes)
      plane.resize(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows));
  }

  int width, height;
  std::array<std::vector<float>, 3> planes;       // red, green, blue: the mean of a pixel's samples
  std::vector<std::vector<MixedFragment>> mixed;  // by row, in a fixed order
};

class PixelFilter {
 public:
  explicit PixelFilter(const Sampling& sampling);

  // Row i of the picture, linear; each of `row` has room for its width.
  void filterRow(const MeanColors& colors, int i, const std::array<std::span<float>, 3>& row) const;

 private:
  void addMixed(const MeanColors& colors, int di, std::span<const MixedFragment> fragments,
                const std::array<std::span<float>, 3>& row) const;

  FilterKernel kernel_;
  // By offset to the right and down, by group of four samples, by which of these are meant: how much more
  // they weigh than their share of all of the pixel's.
  static constexpr std::size_t kSubsets = 16;
  std::size_t groups_;
  std::vector<float> excess_;
};

}  // namespace deltaz
