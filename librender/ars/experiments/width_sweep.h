// What the widths of the machine's numbers are worth: error of coverage, depth and colour against the same
// triangles in double, beside the bits they cost.
//
// Undersampled, triangle by triangle, before anything is hidden. Colour is held against the plane that is
// linear on the screen, so that the formats alone are measured. Deterministic. Cost: some 60 ns a pixel and
// width. Thread-safety: reentrant.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "librender/ars/words/number_profile.h"
#include "librender/ars/words/projected_triangle.h"

namespace deltaz::ars {

struct FormatError {
  // Of the pixels that the unrounded triangles cover, per cent: covered by the machine and not by them, and
  // the other way round.
  double extra = 0, missing = 0;
  // Of pixels covered by both. Depth relative to the pixel's own, colour in codes.
  double depth_mean = 0, depth_largest = 0;
  double color_mean = 0, color_largest = 0;
};

FormatError measureFormats(std::span<const ProjectedTriangle> triangles, const NumberProfile& numbers);

struct WidthPoint {
  std::string width;  // "vertex fraction", "colour mantissa", "plane mantissa", "depth mantissa"
  int bits = 0;
  bool table_8 = false;  // the machine's own
  int triangle_bits = 0, pixel_bits = 0;
  FormatError error;
};

// Each width by itself over a range about Table 8's, all others as in `numbers`.
std::vector<WidthPoint> sweepWidths(std::span<const ProjectedTriangle> triangles,
                                    const NumberProfile& numbers = {});

}  // namespace deltaz::ars
