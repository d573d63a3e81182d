// Grids of posts made from a seed, the same on every machine. Thread-safety: pure function.
#pragma once

#include <cstdint>

#include "formats/area.h"
#include "libdb/source/elevation_source.h"

namespace deltaz {

enum class VoidPattern : std::uint8_t {
  kNone,
  kScattered,  // about every twentieth post
  kHole,       // a disc around the middle, a quarter of the shorter side in radius
  kWestHalf,   // everything west of the middle column
  kSingle,     // the post in the middle
};

struct SyntheticGridOptions {
  double south = 43, west = -80;        // of the south-west post, degrees
  Rational spacing_latitude = {30, 1};  // arc-seconds
  Rational spacing_longitude = {30, 1};
  std::int64_t columns = 121, rows = 121;
  std::uint32_t seed = 1;
  std::int32_t lowest = -40, highest = 2400;  // heights lie within, quanta
  Rational quantum = {1, 1};                  // metres
  VoidPattern voids = VoidPattern::kNone;
};

// The grid, with a header and a source description as if it had been read from a GeoTIFF.
RawGrid syntheticGrid(const SyntheticGridOptions& options = {});

}  // namespace deltaz
