// Where the posts and nodes of a grid lie. Leaf and level boundaries are at global multiples: post g of level
// k is the post g * 2^k of level 0, and node (x, y) of level k covers posts x * leaf .. (x + 1) * leaf of
// that level. Cost: constant per call. Thread-safety: const members from any thread.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "formats/area.h"
#include "formats/node_file.h"
#include "formats/patch_lattice.h"
#include "libdb/access/earth.h"
#include "libdb/access/post_axes.h"

namespace deltaz {

// Half-open range of post indices of one level, along one axis.
struct PostRange {
  std::int64_t begin = 0, end = 0;
  std::int64_t size() const { return end > begin ? end - begin : 0; }
  bool operator==(const PostRange&) const = default;
};

// Coordinate of post `global` (level 0) of an axis: degrees, or units of the projection.
double postCoordinate(const GridAxis& axis, const AxisOrigin& origin, std::int64_t global);
// Degrees, of an axis of a geodetic grid.
double postLongitude(const GridAxis& axis, std::int64_t global_column);
double postLatitude(const GridAxis& axis, std::int64_t global_row);

// floor(a / b) and ceil(a / b) for b > 0.
std::int64_t floorDivide(std::int64_t a, std::int64_t b);
std::int64_t ceilDivide(std::int64_t a, std::int64_t b);

// A post's place without its height: Earth-centred metres on the ellipsoid, and the ellipsoid normal there.
struct PostPlace {
  Vector3 foot, up;
  Vector3 at(double height) const { return foot + up * height; }
};

class GridGeometry {
 public:
  // `patches` is what places the posts of a projected grid; without it only indices may be asked for.
  explicit GridGeometry(const GridHeader& grid, std::shared_ptr<const PatchLattice> patches = nullptr);

  const GridHeader& header() const { return grid_; }
  bool isGeodetic() const { return grid_.kind != "projected"; }
  const std::shared_ptr<const PatchLattice>& patches() const { return patches_; }
  // Geodetic grids only. Copies of a geometry share them.
  const PostAxes& axes() const { return *axes_; }

  // Coordinates of a level-0 post along its axis: degrees, or units of the projection.
  double xCoordinate(std::int64_t global_column) const;
  double yCoordinate(std::int64_t global_row) const;
  // Degrees. Geodetic grids only: there a column has one longitude and a row one latitude.
  double longitude(std::int64_t global_column) const;
  double latitude(std::int64_t global_row) const;

  // For grids of either kind. On a projected grid the same bits at every level and from either side of a
  // node's border.
  PostPlace placeAt(std::int64_t global_column, std::int64_t global_row) const;
  // Latitude and longitude in degrees of a level-0 post, height 0.
  GeodeticPoint geodeticAt(std::int64_t global_column, std::int64_t global_row) const;
  // Level-`level` posts of both ranges, row by row.
  std::vector<PostPlace> postPlaces(int level, PostRange columns, PostRange rows) const;

  // Posts of level `level` inside the area, as indices of that level.
  PostRange columnsAt(int level) const;
  PostRange rowsAt(int level) const;
  // Nodes of a level: x from .begin to .end - 1.
  PostRange nodeColumnsAt(int level) const;
  PostRange nodeRowsAt(int level) const;
  // Posts of one node of a level (its border posts included, the ring not), clipped to the area.
  PostRange nodePosts(PostRange level_posts, std::int32_t node_index) const;

  // Row and column constants of level-`level` posts [range.begin, range.end). Geodetic grids only.
  std::vector<RowConstants> rowConstantsOf(int level, PostRange range) const;
  std::vector<ColumnConstants> columnConstantsOf(int level, PostRange range) const;

  double metres(std::int32_t quanta) const { return static_cast<double>(quanta) * quantum_; }

 private:
  GridHeader grid_;
  double quantum_;
  std::shared_ptr<const PatchLattice> patches_;
  std::shared_ptr<const PostAxes> axes_;
};

}  // namespace deltaz
