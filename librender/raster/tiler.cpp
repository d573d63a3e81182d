#include "librender/raster/tiler.h"

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <tbb/parallel_for.h>

namespace deltaz {
namespace {

// Which of a node's triangles touch which tiles: for each tile of a rectangle of tiles a run of triangle
// indices, in the order of submission.
class NodeBins {
 public:
  NodeBins() = default;
  NodeBins(const PretiledNode& node, int width, int height) {
    std::vector<SampleBounds> touched;  // in tiles
    touched.reserve(node.triangles.size());
    for (const SnappedTriangle& triangle : node.triangles) {
      const SampleBounds samples = sampleBounds(triangle, width, height);
      touched.push_back({samples.first_j / kTileSide, samples.last_j / kTileSide, samples.first_i / kTileSide,
                         samples.last_i / kTileSide});
      const SampleBounds& t = touched.back();
      if (touched.size() == 1) {
        tiles_ = t;
      } else {
        tiles_ = {std::min(tiles_.first_j, t.first_j), std::max(tiles_.last_j, t.last_j),
                  std::min(tiles_.first_i, t.first_i), std::max(tiles_.last_i, t.last_i)};
      }
    }
    if (touched.empty()) return;

    // Counting sort by tile; it keeps the order within each.
    begin_.assign(binOf(tiles_.last_j, tiles_.last_i) + 2, 0);
    const auto for_each_entry = [&](auto&& act) {
      for (std::uint32_t index = 0; index < touched.size(); ++index) {
        const SampleBounds& t = touched[index];
        for (std::int32_t i = t.first_i; i <= t.last_i; ++i) {
          for (std::int32_t j = t.first_j; j <= t.last_j; ++j) act(binOf(j, i), index);
        }
      }
    };
    for_each_entry([&](std::size_t bin, std::uint32_t) { ++begin_[bin + 1]; });
    for (std::size_t bin = 1; bin < begin_.size(); ++bin) begin_[bin] += begin_[bin - 1];
    entries_.resize(begin_.back());
    std::vector<std::uint32_t> next(begin_.begin(), begin_.end() - 1);
    for_each_entry([&](std::size_t bin, std::uint32_t index) { entries_[next[bin]++] = index; });
  }

  template <typename Visit>
  void forEachTriangle(std::int32_t tile_j, std::int32_t tile_i, Visit&& visit) const {
    if (tile_j < tiles_.first_j || tile_j > tiles_.last_j || tile_i < tiles_.first_i ||
        tile_i > tiles_.last_i)
      return;
    const std::size_t bin = binOf(tile_j, tile_i);
    for (std::uint32_t entry = begin_[bin]; entry < begin_[bin + 1]; ++entry) visit(entries_[entry]);
  }

 private:
  std::size_t binOf(std::int32_t tile_j, std::int32_t tile_i) const {
    return static_cast<std::size_t>(tile_i - tiles_.first_i) *
               static_cast<std::size_t>(tiles_.last_j - tiles_.first_j + 1) +
           static_cast<std::size_t>(tile_j - tiles_.first_j);
  }

  SampleBounds tiles_;                  // empty if no triangle touches the picture
  std::vector<std::uint32_t> begin_;    // of each bin in entries_, and the end
  std::vector<std::uint32_t> entries_;  // triangle indices
};

}  // namespace

TilerStatistics tile(const std::vector<PretiledNode>& nodes, DepthFrameBuffer& buffer) {
  const int width = buffer.width(), height = buffer.height();
  std::vector<NodeBins> bins(nodes.size());
  std::vector<std::vector<std::uint8_t>> covers(nodes.size());  // per face: 1 once it covered a sample
  tbb::parallel_for(std::size_t{0}, nodes.size(), [&](std::size_t n) {
    bins[n] = NodeBins(nodes[n], width, height);
    covers[n].assign(nodes[n].faces.size(), 0);
  });

  const int tiles_across = (width + kTileSide - 1) / kTileSide,
            tiles_down = (height + kTileSide - 1) / kTileSide;
  std::vector<TilerStatistics> of_tile(static_cast<std::size_t>(tiles_across) *
                                       static_cast<std::size_t>(tiles_down));
  tbb::parallel_for(std::size_t{0}, of_tile.size(), [&](std::size_t t) {
    const auto tile_j = static_cast<std::int32_t>(t) % tiles_across;
    const auto tile_i = static_cast<std::int32_t>(t) / tiles_across;
    const SampleBounds pixels{tile_j * kTileSide, std::min((tile_j + 1) * kTileSide, width) - 1,
                              tile_i * kTileSide, std::min((tile_i + 1) * kTileSide, height) - 1};
    TilerStatistics counts;
    for (std::size_t n = 0; n < nodes.size(); ++n) {
      const PretiledNode& node = nodes[n];
      bins[n].forEachTriangle(tile_j, tile_i, [&](std::uint32_t index) {
        const SnappedTriangle& triangle = node.triangles[index];
        const FacePlanes& face = node.faces[triangle.face];
        std::uint64_t tested = 0;
        forEachSample(triangle, intersection(sampleBounds(triangle, width, height), pixels),
                      [&](std::int32_t j, std::int32_t i) {
                        ++tested;
                        const auto inverse_u = static_cast<float>(face.inverseDepthAt(j, i));
                        counts.written +=
                            buffer.write(j, i, inverse_u, static_cast<std::uint32_t>(n), triangle.face) ? 1
                                                                                                        : 0;
                      });
        counts.tested += tested;
        // Several tiles may find the same face; all of them store the same value.
        if (tested > 0)
          std::atomic_ref<std::uint8_t>(covers[n][triangle.face]).store(1, std::memory_order_relaxed);
      });
    }
    of_tile[t] = counts;
  });

  TilerStatistics sum;
  for (const TilerStatistics& counts : of_tile) {
    sum.tested += counts.tested;
    sum.written += counts.written;
  }
  for (const std::vector<std::uint8_t>& node : covers) {
    const auto drawn = static_cast<std::uint64_t>(std::count(node.begin(), node.end(), 1));
    sum.faces_drawn += drawn;
    sum.no_sample += node.size() - drawn;
  }
  return sum;
}

}  // namespace deltaz
