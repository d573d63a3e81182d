// The triangles on which the report's experiments are run again. The same numbers on every machine.
//
// The report says that it drew two thousand random triangles of an approximate size (7.1.2.1) and not how.
// Three uniform points in a square, with large areas drawn again, give its oversampling figures from two
// parameters that are fitted to mean sizes only; its undersampling figures below 160 pixels need some needles
// among them (see tiler_tables.h). Thread-safety: each generator by itself.
#pragma once

#include <cstdint>
#include <vector>

#include "librender/ars/words/projected_triangle.h"

namespace deltaz::ars {

// SplitMix64 (Steele, Lea, Flood 2014).
class RandomNumbers {
 public:
  explicit RandomNumbers(std::uint64_t seed) : state_(seed) {}
  std::uint64_t next();
  double uniform(double low, double high);   // high excluded
  std::uint64_t below(std::uint64_t limit);  // limit > 0

 private:
  std::uint64_t state_;
};

struct TrianglePopulation {
  double side = 45.3;          // pixels of the square, at most 480
  double largest_area = 1;     // of the square; areas above are drawn again
  double needle_share = 0;     // of all triangles, 0..1
  double needle_length = 200;  // pixels, +-20 %, in any direction, at most 360
  double needle_width = 1;     // pixels, uniform from 0 to this
};

// Anywhere in a picture of 512 x 512, all of it inside. Depths are those of a plane that faces the eye, 1/U =
// 1; colour is 255.
ProjectedTriangle randomTriangle(RandomNumbers& random, const TrianglePopulation& population);

// cells x cells squares of `pitch` pixels from pixel (0, 0), two triangles each; vertices are pixels.
std::vector<ProjectedTriangle> latticeTriangles(int cells, int pitch);

}  // namespace deltaz::ars
