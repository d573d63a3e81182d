// Three-vectors as the lists a vector unit wants: all x, all y, all z.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "libdb/access/vector3.h"

namespace deltaz {

// Entries behind a list's last that may be read and written: the doubles of the widest vector.
inline constexpr std::size_t kVectorPadding = 8;

// `count` entries and the padding, which is zero. Entries there were stay; a list that was as long before is
// not allocated anew.
inline void resizePadded(std::vector<double>& list, std::size_t count) {
  list.resize(count + kVectorPadding);
  std::fill(list.begin() + static_cast<std::ptrdiff_t>(count), list.end(), 0.0);
}

struct VectorLists {
  std::vector<double> x, y, z;

  std::size_t count() const { return x.size() < kVectorPadding ? 0 : x.size() - kVectorPadding; }
  Vector3 at(std::size_t k) const { return {x[k], y[k], z[k]}; }
  void resize(std::size_t count) {
    for (std::vector<double>* list : {&x, &y, &z}) resizePadded(*list, count);
  }
};

}  // namespace deltaz
