#include "libdb/build/terrain_field.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <map>
#include <mutex>
#include <numbers>
#include <vector>

#include "libdb/access/color_map.h"
#include "libdb/access/vertex_normals.h"

namespace deltaz {

namespace {

constexpr std::size_t kLeavesKept = 256;

// What a post has: a height, and with a rule a colour.
struct Post {
  bool valid = false;
  double height = 0;  // metres
  LinearColor color;
};

struct Leaf {
  std::int64_t first_column = 0, first_row = 0;
  int columns = 0, rows = 0;
  std::vector<Post> posts;
};

Leaf decoded(const TerrainTile& tile, const GridGeometry& geometry, SurfaceRule rule) {
  Leaf leaf{tile.first_column, tile.first_row, tile.columns, tile.rows, {}};
  std::vector<Vector3> normals;
  std::vector<PostPlace> places;
  if (rule != nullptr) {
    normals = vertexNormals(tile, geometry);
    places = geometry.postPlaces(0, {tile.first_column, tile.first_column + tile.columns},
                                 {tile.first_row, tile.first_row + tile.rows});
  }
  for (int j = 0; j < tile.rows; ++j) {
    for (int i = 0; i < tile.columns; ++i) {
      Post post{tile.isValid(i, j), geometry.metres(tile.height(i, j)), {}};
      if (rule != nullptr && post.valid) {
        const Vector3& up = places[leaf.posts.size()].up;
        const double latitude = geometry.isGeodetic()
                                    ? geometry.latitude(tile.first_row + j)
                                    : std::atan2(up.z, std::hypot(up.x, up.y)) * (180.0 / std::numbers::pi);
        post.color = rule(surfacePoint(post.height, normals[leaf.posts.size()], up, latitude));
      }
      leaf.posts.push_back(post);
    }
  }
  return leaf;
}

}  // namespace

struct TerrainField::Leaves {
  const Database& database;
  int grid;
  std::map<std::pair<std::int32_t, std::int32_t>, Node> nodes;  // of level 0
  std::mutex mutex;
  std::map<std::pair<std::int32_t, std::int32_t>, std::shared_ptr<const Leaf>> kept;
  std::deque<std::pair<std::int32_t, std::int32_t>> oldest;

  // Nothing where the grid has no such leaf.
  Result<std::shared_ptr<const Leaf>> leaf(std::int32_t x, std::int32_t y, SurfaceRule rule) {
    const auto node = nodes.find({x, y});
    if (node == nodes.end()) return std::shared_ptr<const Leaf>();
    {
      const std::lock_guard guard(mutex);
      if (const auto found = kept.find({x, y}); found != kept.end()) return found->second;
    }
    DELTAZ_TRY_ASSIGN(const TerrainTile tile, database.terrain(node->second));
    auto made = std::make_shared<const Leaf>(decoded(tile, database.grid(grid), rule));
    const std::lock_guard guard(mutex);
    if (kept.emplace(std::pair(x, y), made).second) oldest.emplace_back(x, y);
    if (oldest.size() > kLeavesKept) {
      kept.erase(oldest.front());
      oldest.pop_front();
    }
    return std::shared_ptr<const Leaf>(made);
  }
};

// The posts around a block, clipped to the grid.
struct TerrainField::Window {
  std::int64_t first_column = 0, first_row = 0, columns = 0, rows = 0;
  std::vector<Post> posts;
  const Post& at(std::int64_t column, std::int64_t row) const {
    return posts[static_cast<std::size_t>((row - first_row) * columns + (column - first_column))];
  }
};

TerrainField::TerrainField() = default;
TerrainField::~TerrainField() = default;

Result<std::unique_ptr<TerrainField>> TerrainField::make(const Database& database, int grid) {
  std::unique_ptr<TerrainField> field(new TerrainField());
  field->leaves_.reset(new Leaves{database, grid, {}, {}, {}, {}});
  DELTAZ_TRY_ASSIGN(const std::vector<Node> nodes, nodesOfLevel(database, grid, 0));
  for (const Node& node : nodes) field->leaves_->nodes.emplace(std::pair(node.record.x, node.record.y), node);
  return field;
}

Result<std::unique_ptr<TerrainField>> TerrainField::ofRamp(const Database& database, int grid,
                                                           const ColorRamp& ramp) {
  DELTAZ_TRY_ASSIGN(std::unique_ptr<TerrainField> field, make(database, grid));
  field->ramp_ = &ramp;
  return field;
}

Result<std::unique_ptr<TerrainField>> TerrainField::ofRule(const Database& database, int grid,
                                                           SurfaceRule rule) {
  DELTAZ_TRY_ASSIGN(std::unique_ptr<TerrainField> field, make(database, grid));
  field->rule_ = rule;
  return field;
}

bool TerrainField::isFiner(const TexelBlock&, int level) const {
  return colorTexelCells(leaves_->database.grid(leaves_->grid).header().leaf_cells, level) > 1;
}

Status TerrainField::load(Window& window) const {
  window.posts.assign(static_cast<std::size_t>(window.columns * window.rows), {});
  const int cells = leaves_->database.grid(leaves_->grid).header().leaf_cells;
  // A leaf holds the posts on its east and north borders too; those beyond the last cell have no leaf.
  const std::int64_t last_column = window.first_column + window.columns - 1,
                     last_row = window.first_row + window.rows - 1;
  for (std::int64_t y = floorDivide(window.first_row - 1, cells); y <= floorDivide(last_row, cells); ++y) {
    for (std::int64_t x = floorDivide(window.first_column - 1, cells); x <= floorDivide(last_column, cells);
         ++x) {
      DELTAZ_TRY_ASSIGN(const std::shared_ptr<const Leaf> leaf,
                        leaves_->leaf(static_cast<std::int32_t>(x), static_cast<std::int32_t>(y), rule_));
      if (!leaf) continue;
      const std::int64_t from_column = std::max(leaf->first_column, window.first_column);
      const std::int64_t to_column = std::min(leaf->first_column + leaf->columns - 1, last_column);
      const std::int64_t to_row = std::min(leaf->first_row + leaf->rows - 1, last_row);
      for (std::int64_t row = std::max(leaf->first_row, window.first_row); row <= to_row; ++row) {
        for (std::int64_t column = from_column; column <= to_column; ++column) {
          window.posts[static_cast<std::size_t>((row - window.first_row) * window.columns +
                                                (column - window.first_column))] =
              leaf->posts[static_cast<std::size_t>((row - leaf->first_row) * leaf->columns +
                                                   (column - leaf->first_column))];
        }
      }
    }
  }
  return Success{};
}

CoveredColor TerrainField::colorAt(const Window& window, double column, double row) const {
  const auto last_column = window.first_column + window.columns - 1,
             last_row = window.first_row + window.rows - 1;
  const double x =
      std::clamp(column, static_cast<double>(window.first_column), static_cast<double>(last_column));
  const double y = std::clamp(row, static_cast<double>(window.first_row), static_cast<double>(last_row));
  const auto i = std::min(static_cast<std::int64_t>(std::floor(x)), last_column - 1);
  const auto j = std::min(static_cast<std::int64_t>(std::floor(y)), last_row - 1);
  const double u = x - static_cast<double>(i), v = y - static_cast<double>(j);
  double weights = 0, height = 0;
  LinearColor color;
  const auto include = [&](const Post& post, double weight) {
    if (!post.valid || weight == 0) return;
    weights += weight;
    height += weight * post.height;
    color = color + post.color * weight;
  };
  include(window.at(i, j), (1 - u) * (1 - v));
  include(window.at(i + 1, j), u * (1 - v));
  include(window.at(i, j + 1), (1 - u) * v);
  include(window.at(i + 1, j + 1), u * v);
  if (ramp_ != nullptr)
    return coveredColor(weights > 0 ? ramp_->colorAt(height / weights) : ramp_->colorOfVoid());
  if (weights == 0) return {};
  return {color.red / weights, color.green / weights, color.blue / weights, 1};
}

Status TerrainField::sample(const TexelBlock& block, std::span<CoveredColor> colors) const {
  const GridHeader& header = leaves_->database.grid(leaves_->grid).header();
  const double texel = colorTexelCells(header.leaf_cells, block.level);
  // First and one more than the last post, two at least, of those the centres lie between.
  const auto range = [texel](std::int64_t first, int count, const GridAxis& axis) {
    const double low = (static_cast<double>(first) + 0.5) * texel,
                 high = (static_cast<double>(first + count) - 0.5) * texel;
    const auto begin = std::clamp<std::int64_t>(static_cast<std::int64_t>(std::floor(low)), axis.first,
                                                axis.first + axis.count - 2);
    const auto last = std::clamp<std::int64_t>(static_cast<std::int64_t>(std::floor(high)) + 1, begin + 1,
                                               axis.first + axis.count - 1);
    return PostRange{begin, last + 1};
  };
  const PostRange columns = range(block.first_column, block.columns, header.x_axis),
                  rows = range(block.first_row, block.rows, header.y_axis);
  Window window{columns.begin, rows.begin, columns.size(), rows.size(), {}};
  DELTAZ_TRY(load(window));
  std::size_t k = 0;
  for (int row = 0; row < block.rows; ++row) {
    for (int column = 0; column < block.columns; ++column) {
      colors[k++] = colorAt(window, (static_cast<double>(block.first_column + column) + 0.5) * texel,
                            (static_cast<double>(block.first_row + row) + 0.5) * texel);
    }
  }
  return Success{};
}

}  // namespace deltaz
