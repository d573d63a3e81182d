// Random triangles as pixels, for loads on the machine: three points uniform in a square, tiled by the path
// of the report's tiler (digest 6.2) with its oversampling tolerance. By itself, so that tests of the tree
// and the memories stand on nothing of the tiler.
#pragma once

#include <cstdint>

#include "librender/ars/machine/pixel_source.h"

namespace deltaz::ars {

struct RandomPixelOptions {
  int triangles = 2000;
  double side = 70.5;       // of the square, pixels
  double most_area = 0.04;  // of a triangle, of the square's
  double line_sigma = 55;   // of the squares' centres about line 256; 0: anywhere
  unsigned seed = 1;
  // Depths: constant on a triangle and log-uniform over three octaves; no two triangles have the same.
  // With `planes` they vary over the triangle and may meet.
  bool planes = false;
};

RecordedPixels randomPixels(const RandomPixelOptions& options);

// Pixels of every place of the picture with the background flag, from the first triangle of the result on.
void addBackground(RecordedPixels& source, std::uint8_t color);

}  // namespace deltaz::ars
