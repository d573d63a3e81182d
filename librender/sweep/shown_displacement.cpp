#include "librender/sweep/shown_displacement.h"

#include <algorithm>
#include <cmath>
#include <exception>
#include <iterator>
#include <limits>
#include <optional>
#include <span>
#include <tbb/parallel_for.h>
#include <unordered_map>
#include <vector>

#include "libdb/access/grid_locator.h"
#include "libdb/access/node_position.h"
#include "libdb/access/plan_shape.h"
#include "librender/scene/arena.h"
#include "librender/scene/seam_index.h"

namespace deltaz {
namespace {

constexpr double kNotMeasured = -1;
constexpr std::size_t kPixelsAtATime = std::size_t{1} << 20;

// A pixel's point on the Earth, and where it lies in the grid that is looked at.
struct Sample {
  std::size_t pixel = 0;
  Vector3 position, foot, up;
  NodePosition leaf;
  GridPlace place;
  bool near = false;  // the grid may have ground there
};

class Measurement {
 public:
  Measurement(const Database& truth, const Camera& camera, const Picture& picture)
      : truth_(truth),
        ellipsoid_(truth.area().grids.front().ellipsoid),
        view_(makeViewTransform(camera, ellipsoid_)),
        picture_(picture),
        seams_(truth),
        displacements_(picture.depth.size(), kNotMeasured) {}

  Result<ShownDisplacement> run() {
    for (std::size_t begin = 0; begin < displacements_.size(); begin += kPixelsAtATime)
      DELTAZ_TRY(measure(begin, std::min(displacements_.size(), begin + kPixelsAtATime)));
    return summary();
  }

 private:
  Status measure(std::size_t begin, std::size_t end) {
    std::vector<Sample> samples;
    for (std::size_t pixel = begin; pixel < end; ++pixel) {
      if (picture_.surface[pixel] != Surface::kTerrain) continue;
      ++terrain_pixels_;
      samples.emplace_back().pixel = pixel;
    }
    tbb::parallel_for(std::size_t{0}, samples.size(), [&](std::size_t k) { placeOnEarth(samples[k]); });
    // Where grids overlap the first one with ground wins.
    for (int grid = 0; grid < truth_.gridCount() && !samples.empty(); ++grid) {
      DELTAZ_TRY(measureOnGrid(grid, samples));
      std::erase_if(samples,
                    [&](const Sample& sample) { return displacements_[sample.pixel] != kNotMeasured; });
    }
    return Success{};
  }

  void placeOnEarth(Sample& sample) const {
    const auto width = static_cast<std::size_t>(picture_.width);
    const auto j = static_cast<double>(sample.pixel % width), i = static_cast<double>(sample.pixel / width);
    sample.position = view_.eye + view_.ray(j, i) * static_cast<double>(picture_.depth[sample.pixel]);
    const GeodeticPoint point = toGeodetic(ellipsoid_, sample.position);
    const RowConstants row = rowConstants(ellipsoid_, point.latitude);
    const ColumnConstants column = columnConstants(point.longitude);
    sample.foot = earthCentred(row, column, 0);
    sample.up = upVector(row, column);
  }

  Status measureOnGrid(int grid, std::vector<Sample>& samples) {
    const GridGeometry& geometry = truth_.grid(grid);
    const GridLocator locator(geometry);
    const PostRange columns = geometry.columnsAt(0), rows = geometry.rowsAt(0);
    const std::int64_t cells = geometry.header().leaf_cells;
    tbb::parallel_for(std::size_t{0}, samples.size(), [&](std::size_t k) {
      Sample& sample = samples[k];
      const std::optional<GridPlace> place = locator.locate(sample.foot);
      // Beyond the last cell's line of posts there is no cell.
      sample.near = place && place->column >= columns.begin && place->column + 1 < columns.end &&
                    place->row >= rows.begin && place->row + 1 < rows.end;
      if (!sample.near) return;
      sample.place = *place;
      sample.leaf = {static_cast<std::uint16_t>(grid), 0,
                     static_cast<std::int32_t>(floorDivide(place->column, cells)),
                     static_cast<std::int32_t>(floorDivide(place->row, cells))};
    });
    const auto order = [](const Sample& a, const Sample& b) {
      if (a.near != b.near) return a.near;
      if (!a.near || a.leaf == b.leaf) return a.pixel < b.pixel;
      return a.leaf.y != b.leaf.y ? a.leaf.y < b.leaf.y : a.leaf.x < b.leaf.x;
    };
    std::sort(samples.begin(), samples.end(), order);
    std::vector<std::span<const Sample>> groups;
    for (auto begin = samples.cbegin(); begin != samples.cend() && begin->near;) {
      const auto end = std::find_if(begin, samples.cend(), [&](const Sample& sample) {
        return !sample.near || !(sample.leaf == begin->leaf);
      });
      groups.emplace_back(begin, end);
      begin = end;
    }
    DELTAZ_TRY_ASSIGN(const auto leaves, leavesOf(groups));
    std::vector<std::optional<Error>> errors(groups.size());
    tbb::parallel_for(std::size_t{0}, groups.size(), [&](std::size_t k) {
      const auto leaf = leaves.find(groups[k].front().leaf);
      if (leaf == leaves.end() || leaf->second.record.isEmpty()) return;
      const Result<TerrainTile> tile = truth_.terrain(leaf->second);
      if (!tile.ok()) {
        errors[k] = tile.error();
      } else {
        measureOnTile(tile.value(), geometry, groups[k]);
      }
    });
    for (const std::optional<Error>& error : errors) {
      if (error) return *error;
    }
    return Success{};
  }

  using Leaves = std::unordered_map<NodePosition, Node, NodePositionHash>;

  // The leaves the groups stand in, found from the root down.
  Result<Leaves> leavesOf(const std::vector<std::span<const Sample>>& groups) const {
    Leaves found;
    std::unordered_map<NodePosition, bool, NodePositionHash> wanted;
    for (const std::span<const Sample>& group : groups) {
      NodePosition position = group.front().leaf;
      const int levels = truth_.grid(position.grid).header().level_count;
      for (int level = 0; level < levels; ++level) {
        wanted[position] = true;
        ++position.level;
        position.x >>= 1;
        position.y >>= 1;
      }
    }
    DELTAZ_TRY_ASSIGN(const Node root, truth_.root());
    std::vector<Node> waiting = {root};
    while (!waiting.empty()) {
      const Node parent = waiting.back();
      waiting.pop_back();
      DELTAZ_TRY_ASSIGN(const std::vector<Node> children, truth_.children(parent));
      for (const Node& child : children) {
        const bool cluster = child.record.type == NodeType::kCluster;
        if (!cluster &&
            (child.record.type != NodeType::kTerrain || !wanted.contains(positionOf(child.record))))
          continue;
        if (!cluster && child.record.level == 0) {
          found.emplace(positionOf(child.record), child);
        } else {
          waiting.push_back(child);
        }
      }
    }
    return found;
  }

  void measureOnTile(const TerrainTile& tile, const GridGeometry& geometry, std::span<const Sample> samples) {
    const std::vector<std::uint8_t> replaced = seams_.replacedFaces(tile);
    for (const Sample& sample : samples) {
      const int i = static_cast<int>(sample.place.column - tile.first_column),
                j = static_cast<int>(sample.place.row - tile.first_row);
      if (i < 0 || j < 0 || i + 1 >= tile.columns || j + 1 >= tile.rows) continue;
      const bool bottom = sample.place.x >= sample.place.y;
      if (!(bottom ? tile.bottomFaceValid(i, j) : tile.topFaceValid(i, j))) continue;
      const auto face = static_cast<std::size_t>((j * (tile.columns - 1) + i) * 2 + (bottom ? 0 : 1));
      if (!replaced.empty() && replaced[face] != 0) continue;
      const PostPlace sw = geometry.placeAt(sample.place.column, sample.place.row),
                      ne = geometry.placeAt(sample.place.column + 1, sample.place.row + 1),
                      third = geometry.placeAt(sample.place.column + (bottom ? 1 : 0),
                                               sample.place.row + (bottom ? 0 : 1));
      if (!coversGround(sw.foot, ne.foot, third.foot)) continue;
      const Vector3 a = sw.at(geometry.metres(tile.height(i, j))),
                    b = ne.at(geometry.metres(tile.height(i + 1, j + 1))),
                    c = third.at(geometry.metres(bottom ? tile.height(i + 1, j) : tile.height(i, j + 1)));
      const Vector3 normal = cross(b - a, c - a);
      const double rise = dot(normal, a - sample.position) / dot(normal, sample.up);
      if (std::isfinite(rise)) displacements_[sample.pixel] = displacement(sample, rise);
    }
  }

  // On the screen, of the sample's point from the one `rise` metres above it.
  double displacement(const Sample& sample, double rise) const {
    const Vector3 shown = view_.toView(sample.position);
    const Vector3 there = view_.toView(sample.position + sample.up * rise);
    if (!(there.x > 0)) return std::numeric_limits<double>::infinity();
    return std::hypot(there.y / there.x - shown.y / shown.x, there.z / there.x - shown.z / shown.x);
  }

  ShownDisplacement summary() {
    std::erase(displacements_, kNotMeasured);
    ShownDisplacement summary;
    summary.measured = displacements_.size();
    summary.unmeasured = terrain_pixels_ - summary.measured;
    if (displacements_.empty()) return summary;
    double squares = 0;
    for (const double pixels : displacements_) {
      summary.largest = std::max(summary.largest, pixels);
      squares += pixels * pixels;
    }
    summary.root_mean_square = std::sqrt(squares / static_cast<double>(displacements_.size()));
    // The smallest of the values that so many are not above.
    const auto rank =
        static_cast<std::ptrdiff_t>(std::ceil(kNearlyAll * static_cast<double>(displacements_.size())) - 1);
    std::nth_element(displacements_.begin(), displacements_.begin() + rank, displacements_.end());
    summary.nearly_all = displacements_[static_cast<std::size_t>(rank)];
    return summary;
  }

  const Database& truth_;
  EllipsoidShape ellipsoid_;
  ViewTransform view_;
  const Picture& picture_;
  SeamIndex seams_;
  std::vector<double> displacements_;  // of each pixel
  std::uint64_t terrain_pixels_ = 0;
};

}  // namespace

Result<ShownDisplacement> measureShownDisplacement(const Database& truth, const Camera& camera,
                                                   const Picture& picture, int threads) {
  std::optional<Result<ShownDisplacement>> result;
  const Result<Picture> ran = drawOnThreads(threads, [&]() -> Result<Picture> {
    result.emplace(Measurement(truth, camera, picture).run());
    return Picture{};
  });
  if (!ran.ok()) return ran.error();
  return *std::move(result);
}

}  // namespace deltaz
