// How far a coarse level may lie from the full-resolution surface between posts, beyond what it does at
// posts.
//
// Over a fine facet, the height of a plane above the ellipsoid along a plan line of slope g has the second
// derivative (1 + 2 g^2) / R (a plane over a sphere in polar form: r = d / cos(t)), so the difference of two
// planes stays within (1 + 2 g^2) d^2 / (8 R) of the interpolation between the posts, d the fine cell's
// diagonal. And a coarse edge, a chord in space, bows sideways in plan by w from the line of posts under it:
// where a fine facet lies across it, the coarse surface departs from the plane beside it by at most the
// change of slope times w. Hence the slack
//   (1 + 2 g0^2) d^2 / (8 R) + 4 gk w,
// g0 the steepest facet of level 0 in a node, gk that of the node's level in the node and those around it,
// d and w the largest at its rows (plan_shape.h).
#pragma once

#include <cstdint>
#include <map>
#include <tuple>

#include "libdb/access/grid_geometry.h"
#include "libdb/access/plan_shape.h"

namespace deltaz {

// Told every node's steepest facet first, then asked. Thread-safety: asking is const.
class BetweenPosts {
 public:
  // `geometry` must outlive it. On a projected grid this samples the area's plan.
  explicit BetweenPosts(const GridGeometry& geometry);

  // The slope (tangent) of the steepest facet that covers ground in a node's own tile.
  void addSteepest(int level, std::int32_t x, std::int32_t y, double slope);

  // Metres, for a node of `level` >= 1; its level 0 and neighbours must have been added.
  double slack(int level, std::int32_t x, std::int32_t y) const;

 private:
  using Key = std::tuple<int, std::int64_t, std::int64_t>;
  double find(const std::map<Key, double>& slopes, const Key& key) const;

  const GridGeometry& geometry_;
  SidewaysBow bow_;
  std::map<Key, double> own_;   // by node
  std::map<Key, double> fine_;  // of level 0 below a node of a coarser level
};

}  // namespace deltaz
