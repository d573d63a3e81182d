// Every node's terrain: that it decodes, is what its record says, lies in the sphere of every node above it,
// and agrees post for post with its children and its neighbours.
//
// Each agreement has one rule that answers for it, so that one wrong post gives as few findings as possible:
// a node answers for the posts it opens (its west and south borders) against its children; shared borders are
// compared with the eastern and northern neighbour; the ring is compared with whoever owns the post.
#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <optional>
#include <string_view>

#include "libdb/check/check_context.h"
#include "libdb/check/node_spheres.h"
#include "libdb/check/parallel_report.h"
#include "libdb/check/report_detail.h"
#include "libdb/check/tile_loader.h"

namespace deltaz {
namespace {

class TerrainRule {
 public:
  explicit TerrainRule(CheckContext& context) : context_(context), loader_(context) {}

  void run() {
    if (context_.tree_sound) spheres_.emplace(context_);
    parallelReport(context_.report, context_.records.size(), 16, [&](std::size_t item, Report& report) {
      const auto number = static_cast<std::uint32_t>(item + 1);
      const NodeRecord& record = context_.record(number);
      if (record.type == NodeType::kTerrain) checkNode(number, record, report);
    });
    loader_.reportRefusedReads(context_.report);
    if (!context_.positions_known) {
      addSkipped(context_.report, "spheres, since the control points of a grid could not be read");
    }
    if (!context_.tree_sound) {
      addSkipped(context_.report, "terrain against parents and neighbours, since the tree is damaged");
    }
  }

 private:
  // A record whose grid or level does not exist was reported by the tree rule; there is nothing to hold its
  // terrain to.
  bool hasPlace(const NodeRecord& record) const {
    return record.grid < context_.grids.size() &&
           record.level < context_.grids[record.grid].header().level_count;
  }

  IssueLocation whereOf(std::uint32_t number) const {
    IssueLocation where = context_.locate(number);
    const NodeRecord& record = context_.record(number);
    if (const auto segment = context_.segments.find(record.segment); segment != context_.segments.end()) {
      where.file = segment->second->reference.name;
    }
    where.block = record.block;
    return where;
  }

  IssueLocation wherePost(std::uint32_t number, std::int64_t column, std::int64_t row) const {
    IssueLocation where = whereOf(number);
    const NodeRecord& record = context_.record(number);
    const std::int64_t step = std::int64_t{1} << record.level;
    if (!context_.positions_known) return where;
    const GeodeticPoint post = context_.grids[record.grid].geodeticAt(column * step, row * step);
    where.longitude = post.longitude;
    where.latitude = post.latitude;
    return where;
  }

  void checkNode(std::uint32_t number, const NodeRecord& record, Report& report) {
    if (!hasPlace(record)) return;
    const auto segment = context_.segments.find(record.segment);
    if (segment == context_.segments.end() || !segment->second->container) return;
    CheckedFile& file = *segment->second;
    if (record.block >= file.damaged_blocks.size() || file.damaged_blocks[record.block] != 0) return;
    const auto loaded = loader_.load(number);
    if (!loaded.ok()) {
      // A reference to the wrong kind of block was reported by the tree rule.
      if (loaded.error().code != IssueCode::kRefData) addError(report, loaded.error(), whereOf(number));
      return;
    }
    const LoadedTile& tile = *loaded.value();
    checkHeader(number, record, tile, report);
    checkHeights(number, record, tile, report);
    if (!context_.tree_sound || !tile.hasPosts()) return;
    if (record.level == 0 && context_.positions_known) checkSpheres(number, record, tile, report);
    if (record.level > 0) checkSubset(number, record, tile, report);
    checkBorders(number, record, tile, report);
    checkRing(number, record, tile, report);
  }

  void checkHeader(std::uint32_t number, const NodeRecord& record, const LoadedTile& tile, Report& report) {
    const GridHeader& grid = context_.grids[record.grid].header();
    const TerrainBlock& block = tile.block;
    const double step = std::ldexp(1.0, record.level);
    std::string_view wrong;
    if (block.spacing_x != grid.x_axis.spacing * step || block.spacing_y != grid.y_axis.spacing * step) {
      wrong = "its spacing is not the grid's";
    } else if (block.quantum != grid.quantum) {
      wrong = "its quantum is not the grid's";
    } else if (block.normal_exponent != grid.normal_exponent) {
      wrong = "its normal exponent is not the grid's";
    } else if (record.level > 0 ? !block.ancestors.empty()
                                : block.ancestors.size() != static_cast<std::size_t>(grid.level_count - 1)) {
      wrong = "it has not one error for each level above a leaf";
    }
    if (wrong.empty()) return;
    report.add(makeIssue(IssueCode::kTileGrid,
                         fmt::format("the terrain's header does not fit the node: {}", wrong),
                         whereOf(number)));
  }

  void checkHeights(std::uint32_t number, const NodeRecord& record, const LoadedTile& tile, Report& report) {
    std::uint32_t valid_posts = 0;
    std::int32_t lowest = 0, highest = 0;
    for (std::int64_t row = tile.rows.begin; row < tile.rows.end; ++row) {
      for (std::int64_t column = tile.columns.begin; column < tile.columns.end; ++column) {
        if (!tile.isValid(column, row)) continue;
        const std::int32_t height = tile.height(column, row);
        lowest = valid_posts == 0 ? height : std::min(lowest, height);
        highest = valid_posts == 0 ? height : std::max(highest, height);
        ++valid_posts;
      }
    }
    if (valid_posts != record.valid_posts) {
      report.add(
          makeIssue(IssueCode::kTileVoids,
                    fmt::format("{} posts are valid, the record says {}", valid_posts, record.valid_posts),
                    whereOf(number)));
    }
    if (valid_posts == 0) return;
    // A leaf's range is that of its posts; a coarser node's range, being that of all leaves below, may be
    // wider.
    const bool right = record.level == 0
                           ? lowest == record.minimum_height && highest == record.maximum_height
                           : lowest >= record.minimum_height && highest <= record.maximum_height;
    if (right) return;
    report.add(makeIssue(IssueCode::kTileHeightRange,
                         fmt::format("the posts' heights are {} to {} quanta, the record says {} to {}",
                                     lowest, highest, record.minimum_height, record.maximum_height),
                         whereOf(number)));
  }

  void checkSpheres(std::uint32_t number, const NodeRecord& record, const LoadedTile& tile, Report& report) {
    const GridGeometry& geometry = context_.grids[record.grid];
    const std::vector<PostPlace> places = geometry.postPlaces(0, tile.columns, tile.rows);
    auto place = places.begin();
    std::vector<Vector3> positions;
    std::vector<std::pair<std::int64_t, std::int64_t>> posts;
    for (std::int64_t row = tile.rows.begin; row < tile.rows.end; ++row) {
      for (std::int64_t column = tile.columns.begin; column < tile.columns.end; ++column, ++place) {
        if (!tile.isValid(column, row)) continue;
        positions.push_back(place->at(geometry.metres(tile.height(column, row))));
        posts.emplace_back(column, row);
      }
    }
    for (std::uint32_t above = number; above != 0; above = context_.parents[above - 1]) {
      const Vector3 centre = spheres_->centre(above);
      const double radius = spheres_->radius(above);
      std::size_t farthest = 0;
      double distance = -1;
      for (std::size_t i = 0; i < positions.size(); ++i) {
        const Vector3 offset = positions[i] - centre;
        if (const double squared = dot(offset, offset); squared > distance) {
          distance = squared;
          farthest = i;
        }
      }
      if (positions.empty() || std::sqrt(distance) <= radius + NodeSpheres::kTolerance) continue;
      IssueLocation where = wherePost(number, posts[farthest].first, posts[farthest].second);
      where.file = context_.nodes->reference.name;
      where.node = above;
      where.block = (above - 1) / kNodesPerPage;
      const double outside = std::sqrt(distance) - radius;
      report.add(makeIssue(IssueCode::kTileSphere,
                           fmt::format("a post of leaf {} lies {:.3f} m outside its sphere", number, outside),
                           where, outside));
    }
  }

  // Compares post (column, row) of `tile` with the same post under other indices in `other`.
  void comparePost(IssueCode code, std::uint32_t number, const LoadedTile& tile, std::int64_t column,
                   std::int64_t row, std::uint32_t other_number, const LoadedTile& other,
                   std::int64_t other_column, std::int64_t other_row, Report& report) {
    const bool valid = tile.isValid(column, row), other_valid = other.isValid(other_column, other_row);
    if (!valid && !other_valid) return;
    const std::int32_t height = tile.height(column, row),
                       other_height = other.height(other_column, other_row);
    if (valid && other_valid && height == other_height) return;
    const NodeRecord& record = context_.record(number);
    const double metres = valid && other_valid ? std::abs(context_.grids[record.grid].metres(height) -
                                                          context_.grids[record.grid].metres(other_height))
                                               : 0.0;
    addLazily(report, code, metres, [&] {
      const std::string message = valid && other_valid
                                      ? fmt::format("height {} quanta here, {} in node {} ({} m apart)",
                                                    height, other_height, other_number, metres)
                                      : fmt::format("{} here, {} in node {}", valid ? "valid" : "void",
                                                    other_valid ? "valid" : "void", other_number);
      return makeIssue(code, message, wherePost(number, column, row), metres);
    });
  }

  void checkSubset(std::uint32_t number, const NodeRecord& record, const LoadedTile& tile, Report& report) {
    const GridGeometry& geometry = context_.grids[record.grid];
    const std::int64_t leaf = geometry.header().leaf_cells;
    const PostRange node_columns = geometry.nodeColumnsAt(record.level),
                    node_rows = geometry.nodeRowsAt(record.level);
    for (std::uint32_t child = record.first_child; child != 0; child = context_.record(child).sibling) {
      const NodeRecord& below = context_.record(child);
      const TilePointer finer = loader_.find(child);
      if (!finer) continue;
      const PostRange child_columns = geometry.nodeColumnsAt(below.level),
                      child_rows = geometry.nodeRowsAt(below.level);
      for (std::int64_t row = tile.rows.begin; row < tile.rows.end; ++row) {
        if (ownerOf(row, leaf, node_rows) != record.y || ownerOf(2 * row, leaf, child_rows) != below.y)
          continue;
        for (std::int64_t column = tile.columns.begin; column < tile.columns.end; ++column) {
          if (ownerOf(column, leaf, node_columns) != record.x ||
              ownerOf(2 * column, leaf, child_columns) != below.x) {
            continue;
          }
          comparePost(IssueCode::kHgtSubset, number, tile, column, row, child, *finer, 2 * column, 2 * row,
                      report);
        }
      }
    }
  }

  std::uint32_t neighbour(const NodeRecord& record, std::int64_t x, std::int64_t y) const {
    return context_.recordAt(
        {record.grid, record.level, static_cast<std::int32_t>(x), static_cast<std::int32_t>(y)});
  }

  void checkBorders(std::uint32_t number, const NodeRecord& record, const LoadedTile& tile, Report& report) {
    const std::int64_t leaf = context_.grids[record.grid].header().leaf_cells;
    const std::uint32_t east = neighbour(record, std::int64_t{record.x} + 1, record.y);
    const std::int64_t east_column = (std::int64_t{record.x} + 1) * leaf;
    if (const TilePointer other = loader_.find(east);
        other && other->hasPosts() && east_column < tile.columns.end) {
      for (std::int64_t row = tile.rows.begin; row < tile.rows.end; ++row) {
        comparePost(IssueCode::kHgtBorder, number, tile, east_column, row, east, *other, east_column, row,
                    report);
      }
    }
    const std::uint32_t north = neighbour(record, record.x, std::int64_t{record.y} + 1);
    const std::int64_t north_row = (std::int64_t{record.y} + 1) * leaf;
    if (const TilePointer other = loader_.find(north);
        other && other->hasPosts() && north_row < tile.rows.end) {
      for (std::int64_t column = tile.columns.begin; column < tile.columns.end; ++column) {
        comparePost(IssueCode::kHgtBorder, number, tile, column, north_row, north, *other, column, north_row,
                    report);
      }
    }
  }

  void checkRing(std::uint32_t number, const NodeRecord& record, const LoadedTile& tile, Report& report) {
    const GridGeometry& geometry = context_.grids[record.grid];
    const std::int64_t leaf = geometry.header().leaf_cells;
    const PostRange all_columns = geometry.columnsAt(record.level), all_rows = geometry.rowsAt(record.level);
    // Which of the three nodes along an axis holds a post: -1, 0 or 1 from this one.
    const auto side = [leaf](std::int64_t post, std::int64_t node) {
      return post < node * leaf ? -1 : post > (node + 1) * leaf ? 1 : 0;
    };
    std::array<std::uint32_t, 9> numbers{};
    std::array<TilePointer, 9> tiles;
    std::array<bool, 9> looked{};
    const auto compare = [&](std::int64_t column, std::int64_t row) {
      if (column < all_columns.begin || column >= all_columns.end || row < all_rows.begin ||
          row >= all_rows.end) {
        if (!tile.isValid(column, row)) return;
        addLazily(report, IssueCode::kHgtRing, 0.0, [&] {
          return makeIssue(IssueCode::kHgtRing, "the ring has a height outside the area",
                           wherePost(number, column, row), 0.0);
        });
        return;
      }
      const int dx = side(column, record.x), dy = side(row, record.y);
      const auto slot = static_cast<std::size_t>((dy + 1) * 3 + dx + 1);
      if (!looked[slot]) {
        looked[slot] = true;
        numbers[slot] = neighbour(record, std::int64_t{record.x} + dx, std::int64_t{record.y} + dy);
        tiles[slot] = loader_.find(numbers[slot]);
      }
      if (!tiles[slot]) return;
      comparePost(IssueCode::kHgtRing, number, tile, column, row, numbers[slot], *tiles[slot], column, row,
                  report);
    };
    for (std::int64_t column = tile.columns.begin - 1; column <= tile.columns.end; ++column) {
      compare(column, tile.rows.begin - 1);
      compare(column, tile.rows.end);
    }
    for (std::int64_t row = tile.rows.begin; row < tile.rows.end; ++row) {
      compare(tile.columns.begin - 1, row);
      compare(tile.columns.end, row);
    }
  }

  CheckContext& context_;
  TileLoader loader_;
  std::optional<NodeSpheres> spheres_;  // if the tree is sound
};

}  // namespace

void checkTerrain(CheckContext& context) {
  if (!context.records_known) {
    addSkipped(context.report, "the terrain of all nodes, whose records could not be read");
    return;
  }
  TerrainRule(context).run();
}

}  // namespace deltaz
