// Where the posts and nodes of a grid lie. Leaf and level boundaries are at global multiples: post g of level
// k is the post g * 2^k of level 0, and node (x, y) of level k covers posts x * leaf .. (x + 1) * leaf of
// that level. Cost: constant per call. Thread-safety: const members from any thread.
#pragma once

#include <cstdint>
#include <vector>

#include "formats/area.h"
#include "formats/node_file.h"
#include "libdb/access/earth.h"

namespace deltaz {

// Half-open range of post indices of one level, along one axis.
struct PostRange {
  std::int64_t begin = 0, end = 0;
  std::int64_t size() const { return end > begin ? end - begin : 0; }
  bool operator==(const PostRange&) const = default;
};

// Degrees of post `global` (level 0) of an axis; `origin` is -180 or -90.
double postDegrees(const GridAxis& axis, double origin, std::int64_t global);

// floor(a / b) and ceil(a / b) for b > 0.
std::int64_t floorDivide(std::int64_t a, std::int64_t b);
std::int64_t ceilDivide(std::int64_t a, std::int64_t b);

class GridGeometry {
 public:
  explicit GridGeometry(const GridHeader& grid);

  const GridHeader& header() const { return grid_; }
  double longitude(std::int64_t global_column) const;  // degrees, level-0 index
  double latitude(std::int64_t global_row) const;

  // Posts of level `level` inside the area, as indices of that level.
  PostRange columnsAt(int level) const;
  PostRange rowsAt(int level) const;
  // Nodes of a level: x from .begin to .end - 1.
  PostRange nodeColumnsAt(int level) const;
  PostRange nodeRowsAt(int level) const;
  // Posts of one node of a level (its border posts included, the ring not), clipped to the area.
  PostRange nodePosts(PostRange level_posts, std::int32_t node_index) const;

  // Row and column constants of level-`level` posts [range.begin, range.end).
  std::vector<RowConstants> rowConstantsOf(int level, PostRange range) const;
  std::vector<ColumnConstants> columnConstantsOf(int level, PostRange range) const;

  double metres(std::int32_t quanta) const { return static_cast<double>(quanta) * quantum_; }

 private:
  GridHeader grid_;
  double quantum_;
};

}  // namespace deltaz
