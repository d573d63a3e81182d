// The tiling machine (report Fig 20, reconstructed), one sampled pixel a step, so that a timed machine can
// stop at back-pressure and go on.
//
// Tiling starts at the corner and follows a line until a pixel behind valid ones is empty or the box ends;
// the next line starts below the first valid pixel of this one (the figure is lost; starting at the box's
// edge would lose most of the reported efficiency). Thread-safety: each cursor by itself.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "librender/ars/tiler/pixel_values.h"
#include "librender/ars/tiler/tiler_setup.h"
#include "librender/ars/words/pixel_packet.h"

namespace deltaz::ars {

class TilingCursor {
 public:
  TilingCursor() = default;  // at the end
  // `numbers` is referred to and outlives the cursor.
  TilingCursor(const TilerSetup& setup, const NumberProfile& numbers);

  bool done() const { return done_; }
  // Samples one pixel, 100 ns, and moves on; nothing if it is empty. Not when done.
  std::optional<PixelPacket> sample();

  std::int64_t sampled() const { return sampled_; }
  std::int64_t tiled() const { return tiled_; }

 private:
  using DotProducts = std::array<std::int64_t, 3>;
  void nextPixel();
  void nextLine();

  TilerSetup setup_;
  const NumberProfile* numbers_ = nullptr;
  bool done_ = true;
  int i_ = 0, j_ = 0, line_ = 0, pixel_ = 0, first_pixel_ = 0;  // I, J; steps from the corner; JSTART
  DotProducts p_{}, p_save_{};
  Displacement line_displacement_, pixel_displacement_,
      saved_displacement_;                              // SDI, SDJ, SDJSAVE, with their colours
  bool before_valid_ = false, line_has_valid_ = false;  // E1
  std::int64_t sampled_ = 0, tiled_ = 0;
};

}  // namespace deltaz::ars
