// What a tiler's stages take and how much they hold (report 4.2.4, 7.1.2.1). The report's "100 microseconds"
// a pixel is 100 ns: 10 MHz.
#pragma once

#include <algorithm>
#include <cstdint>

#include "librender/ars/simulated_time.h"

namespace deltaz::ars {

inline constexpr Picoseconds kWordTransfer =
    1200 * kNanosecond;  // from the host, 8 words a triangle (4.2.3.2)

// Averages over two thousand random triangles (Table 21); the machine itself counts cycles of 8 MHz.
inline constexpr Picoseconds kSetUpCycle = 125 * kNanosecond;
inline constexpr Picoseconds kUndersampleSetUp = 9750 * kNanosecond, kOversampleSetUp = 8630 * kNanosecond;

inline constexpr Picoseconds kTilingLoad = 700 * kNanosecond;  // 7 cycles of the tiling machine (Fig 86)
inline constexpr Picoseconds kSamplePixel = 100 * kNanosecond;

inline constexpr int kTriangleQueue = 2;  // triangles, at the host's interface
inline constexpr int kSetUpQueue = 5;     // triangles, between set-up and tiling machine
inline constexpr int kPixelQueue = 64;    // pixels, before the distribution tree

constexpr Picoseconds setUpTime(bool oversample) {
  return oversample ? kOversampleSetUp : kUndersampleSetUp;
}
constexpr Picoseconds tilingTime(std::int64_t sampled_pixels) {
  return kTilingLoad + sampled_pixels * kSamplePixel;
}
// Of one triangle among many like it: the stages work at the same time, and the slower one decides.
constexpr Picoseconds triangleTime(bool oversample, std::int64_t sampled_pixels) {
  return std::max(setUpTime(oversample), tilingTime(sampled_pixels));
}

}  // namespace deltaz::ars
