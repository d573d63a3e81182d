// How two pictures of one view differ, and how far from the silhouettes of the terrain.
#pragma once

#include <cstdint>
#include <vector>

#include "libdb/access/database.h"
#include "librender/scene/render.h"

namespace deltaz {

struct PictureDifference {
  std::uint64_t pixels = 0;
  std::uint64_t differing = 0;          // some channel by more than 2 of 255
  int largest = 0;                      // of 255
  std::uint64_t coverage = 0;           // terrain in one and not in the other
  double farthest_from_edge = 0;        // pixels, from such a pixel's centre to the nearest projected edge
  double largest_depth_difference = 0;  // relative, where both show the same triangle
};

// Edges are those of all full-resolution faces, projected from GeographicLib positions.
PictureDifference comparePictures(const Database& database, const Camera& camera, const Picture& a,
                                  const Picture& b);

}  // namespace deltaz
