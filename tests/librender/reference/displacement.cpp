#include "tests/librender/reference/displacement.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "librender/scene/view_volume.h"

namespace deltaz {
namespace {

// A whole grid at full resolution.
class FullResolution {
 public:
  static Result<FullResolution> read(const Database& database, int grid) {
    FullResolution whole(database.grid(grid));
    DELTAZ_TRY_ASSIGN(const std::vector<Node> nodes, nodesOfLevel(database, grid, 0));
    for (const Node& node : nodes) {
      DELTAZ_TRY_ASSIGN(const TerrainTile tile, database.terrain(node));
      for (int j = 0; j < tile.rows; ++j) {
        for (int i = 0; i < tile.columns; ++i) {
          const std::size_t index = whole.index(tile.first_column + i, tile.first_row + j);
          whole.heights_[index] = tile.height(i, j);
          whole.valid_[index] = tile.isValid(i, j) ? 1 : 0;
        }
      }
    }
    return whole;
  }

  bool isValid(std::int64_t column, std::int64_t row) const { return valid_[index(column, row)] != 0; }
  std::int32_t height(std::int64_t column, std::int64_t row) const { return heights_[index(column, row)]; }

 private:
  explicit FullResolution(const GridGeometry& geometry)
      : columns_(geometry.columnsAt(0)), rows_(geometry.rowsAt(0)) {
    const auto posts = static_cast<std::size_t>(columns_.size() * rows_.size());
    heights_.assign(posts, 0);
    valid_.assign(posts, 0);
  }
  std::size_t index(std::int64_t column, std::int64_t row) const {
    return static_cast<std::size_t>((row - rows_.begin) * columns_.size() + (column - columns_.begin));
  }
  PostRange columns_, rows_;
  std::vector<std::int32_t> heights_;
  std::vector<std::uint8_t> valid_;
};

struct Point {
  double j = 0, i = 0;
  bool in_front = false, in_picture = false;
};

Point see(const ViewTransform& view, const Vector3& position) {
  const Vector3 p = view.toView(position);
  if (p.x <= kHither) return {};
  const double j = p.y / p.x, i = p.z / p.x;
  return {j, i, true, std::abs(j) <= view.width / 2.0 && std::abs(i) <= view.height / 2.0};
}

}  // namespace

Result<Displacement> measureDisplacement(const Database& database, const Camera& camera, int level) {
  const ViewTransform view = makeViewTransform(camera, database.area().grids.front().ellipsoid);
  Displacement result;
  double sum = 0;
  for (int grid = 0; grid < database.gridCount(); ++grid) {
    const GridGeometry& geometry = database.grid(grid);
    const int grid_level = std::min(level, geometry.header().level_count - 1);
    const std::int64_t step = std::int64_t{1} << grid_level;
    DELTAZ_TRY_ASSIGN(const FullResolution full, FullResolution::read(database, grid));
    DELTAZ_TRY_ASSIGN(const std::vector<Node> nodes, nodesOfLevel(database, grid, grid_level));

    // The posts of one face of the cell whose south-west post is (column, row) at full resolution.
    const auto measure_face = [&](std::int64_t column, std::int64_t row, bool top) {
      const auto corner = [&](std::int64_t di, std::int64_t dj) {
        return geometry.placeAt(column + di, row + dj)
            .at(geometry.metres(full.height(column + di, row + dj)));
      };
      const Vector3 a = corner(0, 0), b = top ? corner(step, step) : corner(step, 0),
                    c = top ? corner(0, step) : corner(step, step);
      const Vector3 normal = cross(b - a, c - a);
      for (std::int64_t dj = 0; dj <= step; ++dj) {
        for (std::int64_t di = top ? 0 : dj; di <= (top ? dj : step); ++di) {
          if (!full.isValid(column + di, row + dj)) continue;
          const PostPlace place = geometry.placeAt(column + di, row + dj);
          const Vector3 post = place.at(geometry.metres(full.height(column + di, row + dj)));
          const Point at = see(view, post);
          if (!at.in_picture) continue;
          const double rise = dot(normal, a - post) / dot(normal, place.up);
          if (!std::isfinite(rise)) continue;  // a face of no extent, at a pole
          const Point drawn = see(view, post + place.up * rise);
          const double pixels = drawn.in_front ? std::hypot(drawn.j - at.j, drawn.i - at.i) : HUGE_VAL;
          result.largest_pixels = std::max(result.largest_pixels, pixels);
          result.largest_metres = std::max(result.largest_metres, std::abs(rise));
          sum += pixels * pixels;
          ++result.posts;
        }
      }
    };
    for (const Node& node : nodes) {
      DELTAZ_TRY_ASSIGN(const TerrainTile tile, database.terrain(node));
      for (int j = 0; j + 1 < tile.rows; ++j) {
        for (int i = 0; i + 1 < tile.columns; ++i) {
          const std::int64_t column = (tile.first_column + i) * step, row = (tile.first_row + j) * step;
          if (tile.bottomFaceValid(i, j)) measure_face(column, row, false);
          if (tile.topFaceValid(i, j)) measure_face(column, row, true);
        }
      }
    }
  }
  if (result.posts > 0) result.mean_square_pixels = sum / static_cast<double>(result.posts);
  return result;
}

}  // namespace deltaz
