// How far the colours of a picture are from those of a better one of the same view. Thread-safety: pure
// functions.
#pragma once

#include <cstdint>

#include "librender/scene/render.h"

namespace deltaz {

struct PictureError {
  std::uint64_t pixels = 0;
  std::uint64_t differing = 0;  // some channel by more than kSeenDifference
  int largest = 0;              // difference of a channel, of 255
  double mean_square = 0;       // over all channels of all pixels, in units of a channel's 1/255

  double differingShare() const;
  // Decibels, 10 log10(255^2 / mean_square); infinite for equal pictures.
  double peakSignalToNoise() const;
};

inline constexpr int kSeenDifference = 2;  // of 255

// Pre: both have the same size.
PictureError comparePictures(const Picture& picture, const Picture& reference);

// Of several views together, as if their pictures were one.
PictureError joined(const PictureError& a, const PictureError& b);

}  // namespace deltaz
