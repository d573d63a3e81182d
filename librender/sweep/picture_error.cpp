#include "librender/sweep/picture_error.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <limits>

namespace deltaz {

double PictureError::differingShare() const {
  return pixels > 0 ? static_cast<double>(differing) / static_cast<double>(pixels) : 0;
}

double PictureError::peakSignalToNoise() const {
  if (mean_square == 0) return std::numeric_limits<double>::infinity();
  return 10 * std::log10(255.0 * 255.0 / mean_square);
}

PictureError comparePictures(const Picture& picture, const Picture& reference) {
  PictureError error;
  error.pixels = picture.rgb.size() / 3;
  std::uint64_t squares = 0;
  for (std::size_t pixel = 0; pixel < picture.rgb.size() / 3; ++pixel) {
    int largest = 0;
    for (std::size_t channel = 3 * pixel; channel < 3 * pixel + 3; ++channel) {
      const int difference = std::abs(int{picture.rgb[channel]} - int{reference.rgb[channel]});
      largest = std::max(largest, difference);
      squares += static_cast<std::uint64_t>(difference * difference);
    }
    error.largest = std::max(error.largest, largest);
    if (largest > kSeenDifference) ++error.differing;
  }
  if (error.pixels > 0)
    error.mean_square = static_cast<double>(squares) / static_cast<double>(3 * error.pixels);
  return error;
}

PictureError joined(const PictureError& a, const PictureError& b) {
  PictureError sum;
  sum.pixels = a.pixels + b.pixels;
  sum.differing = a.differing + b.differing;
  sum.largest = std::max(a.largest, b.largest);
  if (sum.pixels > 0) {
    sum.mean_square =
        (a.mean_square * static_cast<double>(a.pixels) + b.mean_square * static_cast<double>(b.pixels)) /
        static_cast<double>(sum.pixels);
  }
  return sum;
}

}  // namespace deltaz
