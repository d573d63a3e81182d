// How the machine's picture of a database differs from the reference's, and whether its number formats
// account for it, pixel by pixel.
//
// Coverage: where one shows ground or a model and the other does not, the reference's outline must be within
// a pixel, or the machine's triangle beside the pixel, within its tolerance. Order: where they show different
// triangles, the machine's reaches the pixel within its tolerance, and is hidden by less than both triangles'
// bounds: half a unit of the memory's depth (Table 2), half a unit of each plane coefficient times its steps,
// and what depth changes over the distance by which the pixel lies beside the triangle (extrapolation). Depth
// and colour: those of the triangle's own planes, within the same bounds. Whatever lies outside is counted as
// unexplained: it must be 0.
#pragma once

#include <cstdint>
#include <vector>

#include "formats/error.h"
#include "libdb/access/database.h"
#include "librender/scene/render.h"

namespace deltaz {

struct ReferenceComparison {
  std::uint64_t pixels = 0;
  std::uint64_t coverage_at_edges = 0, coverage_unexplained = 0;
  std::uint64_t other_triangle = 0;  // both covered
  std::uint64_t order_beside = 0;    // of these: pixels beside the machine's triangle, within its tolerance
  std::uint64_t order_in_bounds = 0, order_unexplained = 0;
  std::uint64_t depth_compared = 0, depth_unexplained = 0;
  // Colours of slivers, run on beside them, may leave the format (32,736 at most) and end anywhere.
  std::uint64_t color_compared = 0, color_unexplained = 0, color_out_of_range = 0;
  double largest_depth_share = 0, largest_color_share = 0;  // of their bounds
  double largest_color_error = 0;                           // of 255, against the triangle's own plane
  double peak_signal_to_noise = 0;                          // dB, of the picture against the reference's

  bool explained() const {
    return coverage_unexplained + order_unexplained + depth_unexplained + color_unexplained == 0;
  }
};

struct ComparedPictures {
  ReferenceComparison comparison;
  Picture machine, reference;
  std::vector<std::uint8_t> unexplained;  // 1 for such a pixel
};

// At full resolution, whatever the tolerance; one sub-image (512 x 512 at most) and no antialiaser (kUsage).
// Errors: whatever drawing reports.
Result<ComparedPictures> compareWithReference(const Database& database, const RenderOptions& options);

}  // namespace deltaz
