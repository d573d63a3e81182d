// Rays as the lists a vector unit wants. What is computed of lists is what the function of one ray gives, bit
// for bit, on every processor; whole vectors are read and written, up to kVectorPadding entries beyond the
// last.
#pragma once

#include <cstddef>

#include "libdb/access/vector_lists.h"

namespace deltaz {

// Directions as of ViewTransform::ray.
struct RayLists {
  const double *x = nullptr, *y = nullptr, *z = nullptr;
  std::size_t count = 0;
};

}  // namespace deltaz
