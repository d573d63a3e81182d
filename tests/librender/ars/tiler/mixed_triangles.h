// Triangles of all kinds that could upset a tiler: ordinary, slivers, needles, integer vertices, less than a
// pixel, without area.
#pragma once

#include <cstddef>

#include "librender/ars/experiments/random_triangles.h"

namespace deltaz::ars {

inline ProjectedTriangle mixedTriangle(RandomNumbers& random) {
  const auto point = [&](double side) {
    const double i = random.uniform(0, side), j = random.uniform(0, side);
    return ProjectedVertex{.i = i, .j = j, .depth = random.uniform(0.01, 1), .color = random.uniform(0, 255)};
  };
  const auto lattice = [&](double pitch, std::uint64_t count) {
    ProjectedVertex v = point(1);
    v.i = pitch * static_cast<double>(random.below(count));
    v.j = pitch * static_cast<double>(random.below(count));
    return v;
  };
  ProjectedTriangle t;
  const std::uint64_t kind = random.below(100);
  if (kind < 40) {
    for (ProjectedVertex& v : t) v = point(24);
  } else if (kind < 50) {
    t = randomTriangle(random, {.needle_share = 1, .needle_length = 60});
    return t;
  } else if (kind < 60) {
    // A sliver: the third vertex almost between the others.
    t = {point(40), point(40), point(1)};
    const double share = random.uniform(-0.2, 1.2), off = random.uniform(-0.02, 0.02);
    t[2].i = t[0].i + share * (t[1].i - t[0].i) + off;
    t[2].j = t[0].j + share * (t[1].j - t[0].j) + off;
  } else if (kind < 75) {
    for (ProjectedVertex& v : t) v = lattice(1, 16);
  } else if (kind < 80) {
    for (ProjectedVertex& v : t) v = lattice(0.5, 32);
  } else if (kind < 90) {
    for (ProjectedVertex& v : t) v = point(2);
  } else if (kind < 95) {
    // Parallel to an axis, and right-angled.
    t = {point(30), point(30), point(30)};
    t[1].i = t[0].i;
    if (kind < 92) t[2].j = t[1].j;
  } else if (kind < 98) {
    // Without area, or all but.
    t = {lattice(0.25, 64), lattice(0.25, 64), point(1)};
    t[2].i = 0.5 * (t[0].i + t[1].i);
    t[2].j = 0.5 * (t[0].j + t[1].j);
    if (kind == 97) t[2] = t[0];
  } else {
    for (ProjectedVertex& v : t) v = point(100);
  }
  const double i = random.uniform(-1, 412), j = random.uniform(-1, 412);
  const bool whole = kind >= 60 && kind < 80;  // lattices stay on theirs
  for (ProjectedVertex& v : t) {
    v.i += whole ? static_cast<double>(static_cast<int>(i)) : i;
    v.j += whole ? static_cast<double>(static_cast<int>(j)) : j;
  }
  return t;
}

}  // namespace deltaz::ars
