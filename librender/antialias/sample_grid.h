// A picture with several samples a pixel, as a finer picture that the engines draw: its pixels are the sample
// grid (sample_pattern.h), k times as wide and as high. All scales are powers of two, so what is drawn, level
// by level, is what one sample a pixel would draw. Thread-safety: pure functions.
#pragma once

#include "librender/scene/render.h"

namespace deltaz {

// kUsage for a number of samples there is none of, and for pictures whose sample grid is too large.
Status checkSampling(const RenderOptions& options);

// The camera of the sample grid; what is measured in pixels means the same on the screen.
// Pre: checkSampling is content.
RenderOptions onSampleGrid(const RenderOptions& options);

// Places of a picture's samples, and of its pixels' centres, on the sample grid.
class SampleGrid {
 public:
  explicit SampleGrid(const Sampling& sampling)
      : across_(samplesAcross(sampling.count)), offsets_(sampleOffsets(sampling.count, sampling.pattern)) {}

  int across() const { return across_; }
  const SampleOffsets* offsets() const { return offsets_; }
  double centre(int pixel) const { return pixel * across_ + (across_ - 1) / 2.0; }
  // Of sample (j, i) of the grid.
  double placeJ(int j, int i) const { return offsets_ == nullptr ? j : j + offsets_->x[cell(j, i)] / 256.0; }
  double placeI(int j, int i) const { return offsets_ == nullptr ? i : i + offsets_->y[cell(j, i)] / 256.0; }

 private:
  static std::size_t cell(int j, int i) { return static_cast<std::size_t>((i & 3) * 4 + (j & 3)); }

  int across_;
  const SampleOffsets* offsets_;
};

}  // namespace deltaz
