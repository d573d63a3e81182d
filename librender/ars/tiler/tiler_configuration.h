// How a tiler computes: the formats of its numbers, and corrections that the report's machine does not have.
// Thread-safety: plain values.
#pragma once

#include "librender/ars/words/number_profile.h"

namespace deltaz::ars {

// Ours, all off in the report's machine.
struct TilerCorrections {
  // Undersampled triangles take a pixel on an edge only if the edge is a left or a top one, and have no
  // tolerance: pixels of a shared edge are tiled once. Oversampled triangles keep their tolerance, which
  // overlaps neighbours on purpose.
  bool top_left_rule = false;
  // Depths stay within those of the triangle's vertices. Extrapolation beyond them lets grazing surfaces poke
  // through others (Fig 17). Needs the triangle's supplement.
  bool clamp_depth = false;
  // Colour is c/U divided by 1/U, which is linear in space, and not linear on the screen (4.2.2.2, Fig 14).
  // Needs the supplement.
  bool true_color = false;

  bool operator==(const TilerCorrections&) const = default;
};

struct TilerConfiguration {
  NumberProfile numbers;
  TilerCorrections corrections;

  bool operator==(const TilerConfiguration&) const = default;
};

}  // namespace deltaz::ars
