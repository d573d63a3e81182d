#include "libdb/access/between_posts.h"

#include <algorithm>

namespace deltaz {

BetweenPosts::BetweenPosts(const GridGeometry& geometry) : geometry_(geometry), bow_(geometry) {}

void BetweenPosts::addSteepest(int level, std::int32_t x, std::int32_t y, double slope) {
  own_[{level, x, y}] = slope;
  if (level != 0) return;
  for (int above = 1; above < geometry_.header().level_count; ++above) {
    double& of_node = fine_[{above, x >> above, y >> above}];
    of_node = std::max(of_node, slope);
  }
}

double BetweenPosts::find(const std::map<Key, double>& slopes, const Key& key) const {
  const auto found = slopes.find(key);
  return found == slopes.end() ? 0 : found->second;
}

double BetweenPosts::slack(int level, std::int32_t x, std::int32_t y) const {
  const std::int64_t step = std::int64_t{1} << level, span = geometry_.header().leaf_cells * step;
  const PostRange columns = geometry_.columnsAt(0), all_rows = geometry_.rowsAt(0);
  // A coarse cell more on each side: the facet that is met may be the next one.
  const PostRange rows{std::max(all_rows.begin, y * span - step),
                       std::min(all_rows.end, (std::int64_t{y} + 1) * span + step + 1)};
  const double diagonal = largestCell(geometry_, columns, rows).diagonal();
  const double g0 = find(fine_, {level, x, y});
  double gk = 0;
  for (std::int64_t dy = -1; dy <= 1; ++dy) {
    for (std::int64_t dx = -1; dx <= 1; ++dx) gk = std::max(gk, find(own_, {level, x + dx, y + dy}));
  }
  // The smallest radius of curvature there is: the meridian's at the equator.
  const EllipsoidShape& ellipsoid = geometry_.header().ellipsoid;
  const double axes = ellipsoid.inverse_flattening == 0 ? 1 : 1 - 1 / ellipsoid.inverse_flattening;
  const double radius = ellipsoid.semi_major_axis * axes * axes;
  return (1 + 2 * g0 * g0) * diagonal * diagonal / (8 * radius) + 4 * gk * bow_.at(level, rows);
}

}  // namespace deltaz
