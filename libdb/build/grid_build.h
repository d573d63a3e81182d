// One grid on its way into a database: its pyramid and everything that is learnt about the nodes, before any
// file. The steps run in the order they are declared. Nothing depends on the number of threads.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "formats/error.h"
#include "formats/node_file.h"
#include "formats/terrain_segment.h"
#include "libdb/access/between_posts.h"
#include "libdb/access/grid_geometry.h"
#include "libdb/build/node_bounds.h"
#include "libdb/build/pyramid.h"
#include "libdb/build/worker_pool.h"
#include "libdb/source/elevation_source.h"

namespace deltaz {

class GridBuild {
 public:
  // `grid` must outlive it.
  GridBuild(const RawGrid& grid, int leaf_cells);
  GridBuild(const GridBuild&) = delete;
  GridBuild& operator=(const GridBuild&) = delete;

  const RawGrid& source() const { return grid_; }
  const GridHeader& header() const { return geometry_.header(); }
  const GridGeometry& geometry() const { return geometry_; }
  const PyramidPlan& plan() const { return plan_; }

  // Spheres, heights, cones, steepest facets of every node.
  void measureTiles(WorkerPool& workers);
  // What every coarser level differs from the full-resolution posts.
  void measureErrors(WorkerPool& workers);
  // How far every coarser level's valid region lies from the full-resolution one.
  void measureCoverage(WorkerPool& workers);
  // A face that the leaf with cell (column, row) draws instead of its own, into the leaf's bounds. Global
  // level-0 indices; Earth-centred metres.
  void includeSeamFace(std::int64_t column, std::int64_t row, const std::array<Vector3, 3>& face);
  // Bounds of children into parents, up to the whole grid.
  void gatherUpwards();

  // kInvalid if some node reaches farther than its record can say. `area` is the centroid of the whole area.
  Status checkExtent(const std::array<std::int64_t, 3>& area) const;

  // Of everything in the grid.
  const NodeBounds& bounds() const { return bounds_; }
  // Metres.
  double chordSagOfCoarsest() const;
  double largestErrorOfCoarsest() const;

  std::vector<std::byte> encodeBlock(std::size_t node) const;
  // The record of a planned node without what depends on the files: links, grid, segment and block.
  NodeRecord recordOf(std::size_t node) const;

 private:
  struct NodeFacts {
    TileSummary summary;
    std::vector<AncestorError> leaf_errors;  // leaves only
    std::uint32_t maximum_error = 0;         // of the posts below, kErrorUnit
    double sum_of_squares = 0;
    std::uint64_t compared_posts = 0;
    std::uint32_t coverage_error = kUnknownError;
  };
  std::size_t levelBegin(int level) const { return plan_.level_begin[static_cast<std::size_t>(level)]; }
  std::size_t levelEnd(int level) const { return plan_.level_end[static_cast<std::size_t>(level)]; }
  TerrainTile tileOf(std::size_t node) const;
  std::size_t leafOf(std::int64_t column, std::int64_t row) const;
  void putErrors(NodeRecord& record, const PlannedNode& node, const NodeFacts& facts) const;

  const RawGrid& grid_;
  GridGeometry geometry_;
  PyramidPlan plan_;
  std::vector<NodeFacts> facts_;  // by index into plan_.nodes
  BetweenPosts between_posts_;
  NodeBounds bounds_;
};

// Puts bounds into a record whose parent has this centroid; marks it empty if there are none.
void putBounds(NodeRecord& record, const NodeBounds& bounds,
               const std::array<std::int64_t, 3>& parent_centroid);

}  // namespace deltaz
