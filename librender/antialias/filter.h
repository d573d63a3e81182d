// How the samples of a pixel and of its neighbours are weighted: one colour a pixel, from linear light.
//
// All filters are products of one function of x and the same of y, pixels from the pixel's centre:
//   box       1 up to 0.5: the samples of the pixel itself
//   pyramid   1 - |x| up to 1: the report's (4.4), two pixels wide
//   gaussian  exp(-2 x^2) less its value at 1.5, up to there
//   mitchell  the cubic of Mitchell and Netravali (1988), B = C = 1/3, up to 2; sharper, with negative sides
// Weights are divided by the sum of those of all samples within the picture, so that an even colour stays as
// it is, at the picture's edges too. Thread-safety: const members from any thread.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

#include "librender/antialias/sample_pattern.h"

namespace deltaz {

enum class FilterKind : std::uint8_t { kBox, kPyramid, kGaussian, kMitchell };
inline constexpr std::array kFilterKinds = {FilterKind::kBox, FilterKind::kPyramid, FilterKind::kGaussian,
                                            FilterKind::kMitchell};
std::string_view filterName(FilterKind filter);

// Pixels; 0 beyond.
double filterRadius(FilterKind filter);
double filterValue(FilterKind filter, double x);

// What is sampled in a pixel, and how it is put together.
struct Sampling {
  int count = 1;  // of kSampleCounts
  SamplePattern pattern = SamplePattern::kRotated;
  FilterKind filter = FilterKind::kBox;

  // One sample a pixel and nothing of its neighbours.
  bool isPlain() const { return count == 1 && filter == FilterKind::kBox; }
  bool operator==(const Sampling&) const = default;
};

// The weights of a pattern's samples.
class FilterKernel {
 public:
  explicit FilterKernel(const Sampling& sampling);

  // Neighbours a pixel takes samples of, to each side: 0, 1 or 2.
  int reach() const { return reach_; }
  // Of sample s of the pixel dj columns to the right and di rows down, |dj|, |di| <= reach().
  double weight(int dj, int di, int s) const {
    return weight_[place(dj, di) * samples_ + static_cast<std::size_t>(s)];
  }
  // Of all samples of that pixel together.
  double weightOfAll(int dj, int di) const { return all_[place(dj, di)]; }
  // The sum of all weights of pixel (j, i) of a picture: of the samples within it.
  double sum(int j, int i, int width, int height) const;

 private:
  std::size_t place(int dj, int di) const {
    return static_cast<std::size_t>(di + reach_) * static_cast<std::size_t>(2 * reach_ + 1) +
           static_cast<std::size_t>(dj + reach_);
  }

  int reach_;
  std::size_t samples_;
  std::vector<double> weight_, all_;
};

}  // namespace deltaz
