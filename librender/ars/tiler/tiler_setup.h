// The tiling machine setup (report Table 5): from a triangle's variables to what the tiling machine counts
// with.
//
// Table 5 is printed without its absolute values. With them, and every P including its own tolerance:
//   undersample: PTOL = 2^-7 (|NI| + |NJ|) + 2^-6 (|ISTART - RI| + |JSTART - RJ|), what half a unit of
//   rounding in the vertices can do; oversample:  PTOL = 1/2 max(|NI|, |NJ|), half a pixel.
// With other vertex fractions F, 2^-7 and 2^-6 are 2^-(F+1) and 2^-F. Thread-safety: plain values.
#pragma once

#include <array>
#include <cstdint>

#include "librender/ars/tiler/tiler_configuration.h"
#include "librender/ars/words/triangle_variables.h"

namespace deltaz::ars {

// A value at the corner's pixel and what a step adds to it: a line onwards, a pixel onwards, in the direction
// of tiling.
struct SteppedPlane {
  double start = 0, line = 0, pixel = 0;
};

// Counts lines and pixels from the corner: line l is i = i_start + l * i_step.
struct TilerSetup {
  int i_start = 0, j_start = 0;  // ISTART, JSTART: 0..511
  int i_step = 1, j_step = 1;    // 1 or -1
  int lines = 0, pixels = 0;     // |ISTOP - ISTART|, |JSTOP - JSTART|: the box has one more of each
  // Of the three edges, in units of 2^-dot_product_fraction_bits: PSTART, and NI and NJ times the direction
  // of tiling.
  std::array<std::int64_t, 3> p_start{}, p_line{}, p_pixel{};
  SteppedPlane depth, color;  // D0 and C0; gradients as the accumulators hold them
  bool oversample = false, background = false;
  bool single_precision = false;  // whether plain float computes the same bits as the profile's formats

  // With supplement; else nothing is clamped and colour is linear on the screen.
  bool clamp_depth = false, true_color = false;
  double least_depth = 0, greatest_depth = 0;
  SteppedPlane color_over_depth;
};

// `triangle` is tileable (isTileable) in the profile's vertex fractions; `supplement` may be null.
TilerSetup setUpTriangle(const TriangleVariables& triangle, const TilerConfiguration& configuration,
                         const TriangleSupplement* supplement = nullptr);

}  // namespace deltaz::ars
