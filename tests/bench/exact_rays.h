// The picture every renderer aims at: for each pixel centre the nearest triangle its ray meets, by
// ray-triangle intersection in double precision over all triangles whose projection comes near the pixel; no
// snapping, no planes, no hierarchy. Slow and obviously right.
#pragma once

#include <cstdint>
#include <vector>

#include "peer_scenes.h"

namespace deltaz::bench {

struct ExactPicture {
  std::vector<std::uint32_t> rgba;    // rows from the top
  std::vector<std::uint8_t> covered;  // 1 where a triangle is met
};

ExactPicture traceExactly(const PeerScene& scene);

struct PictureError {
  std::uint64_t coverage_mismatches = 0;  // pixels that one picture covers and the other does not
  std::uint64_t off_by_8 = 0;             // pixels with a channel more than 8 levels off
  double psnr = 0;                        // decibels over all channels of all pixels; +infinity if equal
};

// Background pixels are told from covered ones by their colour, which no lit vertex of the scenes has.
PictureError compareWith(const ExactPicture& exact, const std::vector<std::uint32_t>& rgba);

}  // namespace deltaz::bench
