#include "libdb/build/build_terrain.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <deque>
#include <fmt/format.h>
#include <optional>

#include "formats/container.h"
#include "formats/patch_lattice.h"
#include "formats/version.h"
#include "libdb/access/seam_geometry.h"
#include "libdb/build/area_bounds.h"
#include "libdb/build/area_seams.h"
#include "libdb/build/grid_build.h"
#include "libdb/build/publication.h"
#include "libdb/build/worker_pool.h"

namespace deltaz {

namespace {

constexpr std::uint64_t kSegmentBytes = 64u << 20;
// Nodes encoded at a time, so that packed blocks never pile up in memory.
constexpr std::size_t kNodesPerBatch = 512;
// Of node records: views of areas that grow read least more with pages of so many (bench_growth).
constexpr std::uint32_t kRecordsPerPage = 10;
static_assert(kRecordsPerPage <= kNodesPerPage);
// The area's record has its heights in whole metres of 32 bits.
constexpr double kMaximumAreaHeight = 2147483000.0;

// A planned terrain node in the order of the files, and where its terrain went.
struct OrderedNode {
  std::uint16_t grid = 0;
  std::uint32_t node = 0;  // index into the grid's plan
  std::uint32_t segment = 0, block = kNoBlock;
};

class AreaBuild {
 public:
  AreaBuild(const FileSystem& files, std::span<const RawGrid> grids, const BuildOptions& options)
      : files_(files), sources_(grids), options_(options), workers_(options.threads) {
    for (const RawGrid& grid : grids) grids_.emplace_back(grid, options.leaf_cells);
    orderNodes();
  }

  Result<BuildSummary> run(const std::string& target) {
    DELTAZ_TRY_ASSIGN(Publication publication, Publication::begin(files_, target, options_.overwrite));
    double done = 0;
    const double share = 0.6 / static_cast<double>(grids_.size());
    for (GridBuild& grid : grids_) {
      report("bounds", done);
      grid.measureTiles(workers_);
      report("errors", done + 0.3 * share);
      grid.measureErrors(workers_);
      report("coverage", done + 0.8 * share);
      grid.measureCoverage(workers_);
      done += share;
    }
    DELTAZ_TRY_ASSIGN(seams_, makeSeams(sources_));
    for (const Seam& seam : seams_) includeSeam(seam);
    for (GridBuild& grid : grids_) grid.gatherUpwards();
    gatherArea();
    for (const GridBuild& grid : grids_) DELTAZ_TRY(grid.checkExtent(bounds_.centroid));
    report("terrain", 0.6);
    DELTAZ_TRY(writeTerrain(publication));
    report("nodes", 0.95);
    DELTAZ_TRY(writePatches(publication));
    DELTAZ_TRY(writeSeams(publication));
    DELTAZ_TRY(writeNodes(publication));
    describeArea();
    DELTAZ_TRY(publication.publish(area_));
    report("done", 1);
    return summary();
  }

 private:
  void report(std::string_view phase, double fraction) const {
    if (options_.progress) options_.progress(phase, fraction);
  }

  // Breadth first over all grids: depth by depth from each grid's coarsest level, within a depth grid by
  // grid.
  void orderNodes() {
    numbers_.resize(grids_.size());
    int deepest = 0;
    for (std::size_t g = 0; g < grids_.size(); ++g) {
      numbers_[g].resize(grids_[g].plan().nodes.size());
      deepest = std::max(deepest, grids_[g].plan().level_count);
    }
    for (int depth = 0; depth < deepest; ++depth) {
      for (std::size_t g = 0; g < grids_.size(); ++g) {
        const PyramidPlan& plan = grids_[g].plan();
        if (depth >= plan.level_count) continue;
        const auto level = static_cast<std::size_t>(plan.level_count - 1 - depth);
        for (std::uint32_t node = plan.level_begin[level]; node < plan.level_end[level]; ++node) {
          // Records 1 and onwards are the area's and the grids' clusters.
          numbers_[g][node] = static_cast<std::uint32_t>(order_.size() + grids_.size() + 2);
          order_.push_back({static_cast<std::uint16_t>(g), node});
        }
      }
    }
  }

  // Seams move faces off the posts of the leaves that draw them, so the leaves' bounds must reach there.
  void includeSeam(const Seam& seam) {
    const auto post_at = [&](std::uint16_t grid, std::int64_t column, std::int64_t row) {
      const RawGrid& source = sources_[grid];
      const GridGeometry& geometry = grids_[grid].geometry();
      return geometry.placeAt(column, row)
          .at(geometry.metres(
              source.height(column - source.header.x_axis.first, row - source.header.y_axis.first)));
    };
    std::vector<Vector3> positions;
    for (const SeamVertex& vertex : seam.vertices)
      positions.push_back(seamVertexPosition(seam, vertex, post_at));
    for (const SeamSide side : {SeamSide::kUpper, SeamSide::kLower}) {
      for (const ReplacedFace& replaced : seam.replacedOf(side)) {
        for (std::uint32_t f = 0; f < replaced.face_count; ++f) {
          const auto& [a, b, c] = seam.faces[replaced.first_face + f];
          grids_[gridOf(seam, side)].includeSeamFace(replaced.column, replaced.row,
                                                     {positions[a], positions[b], positions[c]});
        }
      }
    }
  }

  void gatherArea() {
    std::vector<NodeBounds> of_grids;
    bool first = true;
    for (const GridBuild& grid : grids_) {
      of_grids.push_back(grid.bounds());
      if (grid.bounds().empty) continue;
      const double low = grid.geometry().metres(grid.bounds().minimum_height);
      const double high = grid.geometry().metres(grid.bounds().maximum_height);
      area_.lowest_height = first ? low : std::min(area_.lowest_height, low);
      area_.highest_height = first ? high : std::max(area_.highest_height, high);
      first = false;
    }
    // A single grid's bounds are the area's; a second sphere around them would only be larger.
    if (grids_.size() == 1) {
      bounds_ = of_grids.front();
    } else {
      includeChildren(bounds_, of_grids);
    }
  }

  Status writeTerrain(Publication& publication) {
    std::optional<ContainerWriter> writer;
    std::string name;
    std::uint32_t segment = 0;
    const auto finishSegment = [&]() -> Status {
      DELTAZ_TRY_ASSIGN(const FileIdentity identity, writer->finish());
      area_.files.push_back({FileRole::kTerrain, segment, name, identity.length, identity.id});
      writer.reset();
      ++segment;
      return Success{};
    };
    for (std::size_t first = 0; first < order_.size(); first += kNodesPerBatch) {
      const std::size_t count = std::min(kNodesPerBatch, order_.size() - first);
      std::vector<std::vector<std::byte>> blocks(count);
      workers_.forEach(count, [&](std::size_t i) {
        blocks[i] = grids_[order_[first + i].grid].encodeBlock(order_[first + i].node);
      });
      for (std::size_t i = 0; i < count; ++i) {
        if (!writer) {
          name = fmt::format("terrain-{:06}-{:03}.dzt", publication.generation(), segment);
          DELTAZ_TRY_ASSIGN(
              ContainerWriter created,
              ContainerWriter::create(files_, publication.newFilePath(name), ContentKind::kTerrain));
          writer.emplace(std::move(created));
        }
        order_[first + i].segment = segment;
        DELTAZ_TRY_ASSIGN(order_[first + i].block, writer->append(BlockType::kTerrainNode, blocks[i]));
        if (writer->size() >= kSegmentBytes) DELTAZ_TRY(finishSegment());
      }
      report("terrain", 0.6 + 0.35 * static_cast<double>(first + count) / static_cast<double>(order_.size()));
    }
    if (writer) DELTAZ_TRY(finishSegment());
    return Success{};
  }

  // The control points of every projected grid.
  Status writePatches(Publication& publication) {
    for (std::size_t g = 0; g < grids_.size(); ++g) {
      const std::shared_ptr<const PatchLattice>& lattice = grids_[g].source().patches;
      if (!lattice) continue;
      const std::string name = fmt::format("patches-{:06}-{:03}.dzp", publication.generation(), g);
      DELTAZ_TRY_ASSIGN(ContainerWriter writer, ContainerWriter::create(files_, publication.newFilePath(name),
                                                                        ContentKind::kPatches));
      const auto row_size = static_cast<std::size_t>(lattice->pointColumns() * 3);
      for (std::size_t begin = 0; begin < lattice->controls.size(); begin += row_size) {
        DELTAZ_TRY_ASSIGN(
            [[maybe_unused]] const std::uint32_t block,
            writer.append(BlockType::kPatchRow,
                          encodePatchRow(std::span(lattice->controls).subspan(begin, row_size))));
      }
      DELTAZ_TRY_ASSIGN(const FileIdentity identity, writer.finish());
      area_.files.push_back(
          {FileRole::kPatches, static_cast<std::uint32_t>(g), name, identity.length, identity.id});
    }
    return Success{};
  }

  Status writeSeams(Publication& publication) {
    if (seams_.empty()) return Success{};
    const std::string name = fmt::format("seams-{:06}.dzj", publication.generation());
    DELTAZ_TRY_ASSIGN(ContainerWriter writer,
                      ContainerWriter::create(files_, publication.newFilePath(name), ContentKind::kSeams));
    for (const Seam& seam : seams_) {
      DELTAZ_TRY_ASSIGN([[maybe_unused]] const std::uint32_t block,
                        writer.append(BlockType::kSeam, encodeSeam(seam)));
    }
    DELTAZ_TRY_ASSIGN(const FileIdentity identity, writer.finish());
    area_.files.push_back({FileRole::kSeams, 0, name, identity.length, identity.id});
    return Success{};
  }

  // A cluster's record: no data, all children's bounds.
  static NodeRecord clusterRecord(std::uint8_t level, const NodeBounds& bounds,
                                  const std::array<std::int64_t, 3>& parent_centroid) {
    NodeRecord record;
    record.type = NodeType::kCluster;
    record.level = level;
    record.geometric_error = record.coverage_error = record.rms_error = kUnknownError;
    putBounds(record, bounds, parent_centroid);
    return record;
  }

  std::vector<NodeRecord> clusterRecords() const {
    std::vector<NodeRecord> records;
    NodeRecord area = clusterRecord(kAreaLevel, bounds_, bounds_.centroid);
    area.first_child = 2;
    if (!bounds_.empty) {
      area.minimum_height = static_cast<std::int32_t>(std::floor(area_.lowest_height));
      area.maximum_height = static_cast<std::int32_t>(std::ceil(area_.highest_height));
    }
    records.push_back(area);
    for (std::size_t g = 0; g < grids_.size(); ++g) {
      NodeRecord cluster = clusterRecord(static_cast<std::uint8_t>(grids_[g].plan().level_count),
                                         grids_[g].bounds(), bounds_.centroid);
      cluster.grid = static_cast<std::uint16_t>(g);
      cluster.first_child = numbers_[g].front();
      cluster.sibling = g + 1 < grids_.size() ? static_cast<std::uint32_t>(g + 3) : 0;
      records.push_back(cluster);
    }
    return records;
  }

  NodeRecord recordOf(const OrderedNode& ordered) const {
    const GridBuild& grid = grids_[ordered.grid];
    const std::vector<PlannedNode>& nodes = grid.plan().nodes;
    const PlannedNode& node = nodes[ordered.node];
    NodeRecord record = grid.recordOf(ordered.node);
    record.grid = ordered.grid;
    record.segment = ordered.segment;
    record.block = ordered.block;
    record.first_child = node.child_count == 0 ? 0 : numbers_[ordered.grid][node.first_child];
    // The children of one parent stand together.
    const std::size_t next = ordered.node + std::size_t{1};
    const bool has_sibling =
        next < nodes.size() && nodes[next].parent == node.parent && nodes[next].level == node.level;
    record.sibling = has_sibling ? numbers_[ordered.grid][next] : 0;
    return record;
  }

  Status writeNodes(Publication& publication) {
    std::vector<NodeRecord> records = clusterRecords();
    records.reserve(records.size() + order_.size());
    for (const OrderedNode& node : order_) records.push_back(recordOf(node));

    const std::string name = fmt::format("nodes-{:06}.dzn", publication.generation());
    DELTAZ_TRY_ASSIGN(ContainerWriter writer,
                      ContainerWriter::create(files_, publication.newFilePath(name), ContentKind::kNodes));
    for (std::size_t first = 0; first < records.size(); first += kRecordsPerPage) {
      const std::span<const NodeRecord> page =
          std::span(records).subspan(first, std::min<std::size_t>(kRecordsPerPage, records.size() - first));
      DELTAZ_TRY_ASSIGN([[maybe_unused]] const std::uint32_t block,
                        writer.append(BlockType::kPackedNodePage,
                                      encodeNodePage(page, static_cast<std::uint32_t>(first + 1))));
    }
    DELTAZ_TRY_ASSIGN(const FileIdentity identity, writer.finish());
    area_.files.insert(area_.files.begin(), {FileRole::kNodes, 0, name, identity.length, identity.id});
    area_.node_count = static_cast<std::uint32_t>(records.size());
    area_.nodes_per_page = kRecordsPerPage;
    return Success{};
  }

  void describeArea() {
    std::vector<const GridGeometry*> geometries;
    double sag = 0;
    for (const GridBuild& grid : grids_) {
      geometries.push_back(&grid.geometry());
      area_.grids.push_back(grid.header());
      sag = std::max(sag, grid.chordSagOfCoarsest());
    }
    const DegreeBounds bounds = boundsOf(geometries);
    area_.west = bounds.west;
    area_.south = bounds.south;
    area_.east = bounds.east;
    area_.north = bounds.north;
    area_.centroid = bounds_.centroid;
    area_.sea_drop = std::ceil(sag / kErrorUnit) * kErrorUnit;
    area_.tool_version = fmt::format("deltaz {}", version());
    area_.options = options_.provenance;
    area_.options.emplace_back("leaf", std::to_string(options_.leaf_cells));
    std::sort(area_.options.begin(), area_.options.end());
  }

  BuildSummary summary() const {
    BuildSummary result;
    result.nodes = area_.node_count;
    for (const GridBuild& grid : grids_) {
      const RawGrid& source = grid.source();
      result.levels = std::max(result.levels, grid.plan().level_count);
      result.posts += source.heights.size();
      result.voids +=
          static_cast<std::uint64_t>(std::count(source.valid.begin(), source.valid.end(), std::uint8_t{0}));
      result.largest_error = std::max(result.largest_error, grid.largestErrorOfCoarsest());
    }
    for (const FileReference& file : area_.files) result.bytes += file.length;
    result.bytes += serializeArea(area_).size();
    return result;
  }

  const FileSystem& files_;
  std::span<const RawGrid> sources_;
  const BuildOptions& options_;
  WorkerPool workers_;
  std::deque<GridBuild> grids_;
  std::vector<OrderedNode> order_;                   // terrain nodes in the order of their records
  std::vector<std::vector<std::uint32_t>> numbers_;  // record number by grid and planned node
  NodeBounds bounds_;                                // of the area; heights mean nothing
  AreaHeader area_;
  std::vector<Seam> seams_;
};

Status checkGrids(std::span<const RawGrid> grids, int leaf_cells) {
  constexpr std::size_t kMostGrids = 0xFFFF;
  if (grids.empty() || grids.size() > kMostGrids)
    return usageError("sources", fmt::format("{} grids do not make an area", grids.size()));
  for (const RawGrid& grid : grids) {
    const GridHeader& header = grid.header;
    if (header.ellipsoid != grids.front().header.ellipsoid) {
      return usageError(
          "sources", "the grids stand on different ellipsoids",
          fmt::format("one is {} m, 1/{}, another {} m, 1/{}", grids.front().header.ellipsoid.semi_major_axis,
                      grids.front().header.ellipsoid.inverse_flattening, header.ellipsoid.semi_major_axis,
                      header.ellipsoid.inverse_flattening),
          "Bring all sources to one datum first");
    }
    // Before any tree is planned: what lies beyond has no place in a node record.
    GridHeader leaves = header;
    leaves.leaf_cells = leaf_cells;
    const GridGeometry geometry(leaves);
    for (const PostRange nodes : {geometry.nodeColumnsAt(0), geometry.nodeRowsAt(0)}) {
      if (nodes.begin < INT32_MIN || nodes.end > INT32_MAX) {
        return invalidError(IssueCode::kNone, "sources", "the posts stand too close to be numbered",
                            fmt::format("leaves of {} cells would have numbers beyond 32 bits", leaf_cells),
                            "Use larger leaves (--leaf)");
      }
    }
    for (const std::int32_t height : grid.heights) {
      if (std::abs(geometry.metres(height)) <= kMaximumAreaHeight) continue;
      return invalidError(IssueCode::kNone, "sources",
                          fmt::format("the elevation {} m is out of range", geometry.metres(height)),
                          fmt::format("a database holds up to {} m", kMaximumAreaHeight),
                          "Check the unit of the heights");
    }
    const bool projected = header.kind == "projected";
    const bool placed =
        grid.patches != nullptr && header.patches.has_value() && grid.patches->placement == *header.patches &&
        grid.patches->controls.size() ==
            static_cast<std::size_t>(grid.patches->pointColumns() * grid.patches->pointRows() * 3);
    if (projected != placed || projected != (grid.patches != nullptr))
      return internalError("sources", "a grid's control points are not what its header says");
  }
  return Success{};
}

}  // namespace

Result<BuildSummary> buildTerrain(const FileSystem& files, std::span<const RawGrid> grids,
                                  const std::string& target, const BuildOptions& options) {
  if (options.leaf_cells < 8 || options.leaf_cells > static_cast<int>(kMaximumLeafCells) ||
      !std::has_single_bit(static_cast<unsigned>(options.leaf_cells))) {
    return usageError("--leaf", fmt::format("{} cells", options.leaf_cells),
                      "a leaf has a power of two of cells a side, from 8 to 1024");
  }
  DELTAZ_TRY(checkGrids(grids, options.leaf_cells));
  try {
    return AreaBuild(files, grids, options).run(target);
  } catch (const std::bad_alloc&) {
    return accessError(target, "cannot build the database", "there is not enough memory");
  } catch (const std::exception& exception) {
    return internalError(target, exception.what());
  }
}

Result<BuildSummary> buildTerrain(const FileSystem& files, const RawGrid& grid, const std::string& target,
                                  const BuildOptions& options) {
  return buildTerrain(files, std::span(&grid, 1), target, options);
}

}  // namespace deltaz
