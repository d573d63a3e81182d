#include "libdb/build/build_terrain.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <fmt/format.h>
#include <limits>
#include <numbers>
#include <tbb/blocked_range.h>
#include <tbb/info.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>
#include <vector>

#include "formats/container.h"
#include "formats/version.h"
#include "libdb/build/facet_error.h"
#include "libdb/build/node_bounds.h"
#include "libdb/build/publication.h"
#include "libdb/build/pyramid.h"

namespace deltaz {

namespace {

constexpr std::uint64_t kSegmentBytes = 64u << 20;
// Nodes encoded at a time, so that packed blocks never pile up in memory.
constexpr std::size_t kNodesPerBatch = 512;

// Calls work(i) for 0 <= i < count on the threads of `arena`; the order must not matter.
template <typename Work>
void inParallel(tbb::task_arena& arena, std::size_t count, const Work& work) {
  arena.execute([&] {
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count),
                      [&](const tbb::blocked_range<std::size_t>& range) {
                        for (std::size_t i = range.begin(); i != range.end(); ++i) work(i);
                      });
  });
}

// Everything a build learns about its nodes, by index into PyramidPlan::nodes.
struct NodeFacts {
  TileSummary summary;
  std::vector<AncestorError> leaf_errors;  // leaves only
  std::uint32_t maximum_error = 0;         // of the posts below, kErrorUnit
  double sum_of_squares = 0;
  std::uint64_t compared_posts = 0;
  std::uint32_t segment = 0, block = kNoBlock;
};

class TerrainBuild {
 public:
  TerrainBuild(const FileSystem& files, const RawGrid& grid, const BuildOptions& options)
      : files_(files),
        grid_(grid),
        options_(options),
        header_(grid.header),
        geometry_(makeHeader(grid, options)),
        // More threads than the machine has would only wait for each other.
        arena_(options.threads > 0 ? std::min(options.threads, tbb::info::default_concurrency())
                                   : tbb::task_arena::automatic) {
    plan_ = planPyramid(geometry_);
    header_ = geometry_.header();
    header_.level_count = plan_.level_count;
    facts_.resize(plan_.nodes.size());
  }

  Result<BuildSummary> run(const std::string& target) {
    DELTAZ_TRY_ASSIGN(Publication publication, Publication::begin(files_, target, options_.overwrite));
    report("bounds", 0);
    measureTiles();
    report("errors", 0.2);
    measureErrors();
    gatherUpwards();
    report("terrain", 0.6);
    DELTAZ_TRY(writeTerrain(publication));
    report("nodes", 0.95);
    DELTAZ_TRY(writeNodes(publication));
    describeArea();
    DELTAZ_TRY(publication.publish(area_));
    report("done", 1);
    return summary();
  }

 private:
  static GridHeader makeHeader(const RawGrid& grid, const BuildOptions& options) {
    GridHeader header = grid.header;
    header.leaf_cells = options.leaf_cells;
    header.normal_exponent = 2;
    return header;
  }

  void report(std::string_view phase, double fraction) const {
    if (options_.progress) options_.progress(phase, fraction);
  }

  std::size_t levelBegin(int level) const { return plan_.level_begin[static_cast<std::size_t>(level)]; }
  std::size_t levelEnd(int level) const { return plan_.level_end[static_cast<std::size_t>(level)]; }
  TerrainTile tileOf(std::size_t index) const {
    const PlannedNode& node = plan_.nodes[index];
    return cutTile(grid_, geometry_, node.level, node.x, node.y);
  }

  void measureTiles() {
    inParallel(arena_, plan_.nodes.size(),
               [&](std::size_t i) { facts_[i].summary = summarizeTile(tileOf(i), geometry_); });
    steepest_.assign(static_cast<std::size_t>(plan_.level_count), 0.0);
    for (std::size_t i = 0; i < plan_.nodes.size(); ++i) {
      double& steepest = steepest_[static_cast<std::size_t>(plan_.nodes[i].level)];
      steepest = std::max(steepest, facts_[i].summary.steepest);
    }
  }

  void measureErrors() {
    const std::size_t begin = levelBegin(0);
    inParallel(arena_, levelEnd(0) - begin, [&](std::size_t i) {
      const PlannedNode& leaf = plan_.nodes[begin + i];
      facts_[begin + i].leaf_errors = leafErrors(grid_, geometry_, plan_.level_count, leaf.x, leaf.y);
    });
    // Every ancestor of a leaf takes the leaf's errors against its own level.
    for (std::size_t leaf = begin; leaf < levelEnd(0); ++leaf) {
      std::size_t ancestor = leaf;
      for (const AncestorError& error : facts_[leaf].leaf_errors) {
        ancestor = plan_.nodes[ancestor].parent;
        NodeFacts& facts = facts_[ancestor];
        facts.maximum_error = std::max(facts.maximum_error, error.maximum);
        facts.sum_of_squares += static_cast<double>(error.sum_of_squares);
        facts.compared_posts += error.posts;
      }
    }
  }

  // Bounds of children into parents; children stand behind their parents.
  void gatherUpwards() {
    for (std::size_t i = plan_.nodes.size(); i-- > 0;) {
      const PlannedNode& node = plan_.nodes[i];
      if (node.child_count == 0) continue;
      std::vector<NodeBounds> children;
      for (std::uint32_t c = 0; c < node.child_count; ++c)
        children.push_back(facts_[node.first_child + c].summary.bounds);
      includeChildren(facts_[i].summary.bounds, children);
    }
    std::vector<NodeBounds> top;
    const int top_level = plan_.level_count - 1;
    for (std::size_t i = levelBegin(top_level); i < levelEnd(top_level); ++i)
      top.push_back(facts_[i].summary.bounds);
    includeChildren(grid_bounds_, top);
  }

  std::vector<std::byte> encode(std::size_t index) const {
    const PlannedNode& node = plan_.nodes[index];
    TerrainTile tile = tileOf(index);
    TerrainBlock block;
    block.columns = static_cast<std::uint16_t>(tile.columns);
    block.rows = static_cast<std::uint16_t>(tile.rows);
    block.first_column =
        static_cast<std::uint16_t>(tile.first_column - std::int64_t{node.x} * header_.leaf_cells);
    block.first_row = static_cast<std::uint16_t>(tile.first_row - std::int64_t{node.y} * header_.leaf_cells);
    const double scale = static_cast<double>(std::int64_t{1} << node.level);
    block.spacing_x = header_.x_axis.spacing * scale;
    block.spacing_y = header_.y_axis.spacing * scale;
    block.quantum = header_.quantum;
    block.heights = std::move(tile.heights);
    block.valid = std::move(tile.valid);
    block.ancestors = facts_[index].leaf_errors;
    return encodeTerrainBlock(block);
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
    for (std::size_t first = 0; first < plan_.nodes.size(); first += kNodesPerBatch) {
      const std::size_t count = std::min(kNodesPerBatch, plan_.nodes.size() - first);
      std::vector<std::vector<std::byte>> blocks(count);
      inParallel(arena_, count, [&](std::size_t i) { blocks[i] = encode(first + i); });
      for (std::size_t i = 0; i < count; ++i) {
        if (!writer) {
          name = fmt::format("terrain-{:06}-{:03}.dzt", publication.generation(), segment);
          DELTAZ_TRY_ASSIGN(
              ContainerWriter created,
              ContainerWriter::create(files_, publication.newFilePath(name), ContentKind::kTerrain));
          writer.emplace(std::move(created));
        }
        facts_[first + i].segment = segment;
        DELTAZ_TRY_ASSIGN(facts_[first + i].block, writer->append(BlockType::kTerrainNode, blocks[i]));
        if (writer->size() >= kSegmentBytes) DELTAZ_TRY(finishSegment());
      }
      report("terrain",
             0.6 + 0.35 * static_cast<double>(first + count) / static_cast<double>(plan_.nodes.size()));
    }
    if (writer) DELTAZ_TRY(finishSegment());
    return Success{};
  }

  // Record of planned node `index`; record numbers 1 and 2 are the clusters.
  NodeRecord recordOf(std::size_t index) const {
    const PlannedNode& node = plan_.nodes[index];
    const NodeFacts& facts = facts_[index];
    NodeRecord record;
    record.type = NodeType::kTerrain;
    record.level = static_cast<std::uint8_t>(node.level);
    record.child_number = node.child_number;
    record.x = node.x;
    record.y = node.y;
    record.first_child = node.child_count == 0 ? 0 : recordNumber(node.first_child);
    const bool last = node.parent == kNoNode ? index + 1 == levelEnd(node.level)
                                             : index + 1 == plan_.nodes[node.parent].first_child +
                                                                plan_.nodes[node.parent].child_count;
    record.sibling = last ? 0 : recordNumber(index + 1);
    record.segment = facts.segment;
    record.block = facts.block;
    record.valid_posts = facts.summary.valid_posts;
    if (facts.summary.void_posts > 0) record.flags |= kNodeHasVoids;
    const NodeBounds& parent = node.parent == kNoNode ? grid_bounds_ : facts_[node.parent].summary.bounds;
    putBounds(record, facts.summary.bounds, parent.centroid);
    putErrors(record, node, facts);
    return record;
  }

  static std::uint32_t recordNumber(std::size_t index) { return static_cast<std::uint32_t>(index + 3); }

  static void putBounds(NodeRecord& record, const NodeBounds& bounds,
                        const std::array<std::int64_t, 3>& parent_centroid) {
    if (bounds.empty) {
      record.flags |= kNodeIsEmpty;
      return;
    }
    for (std::size_t k = 0; k < 3; ++k)
      record.centroid_offset[k] = static_cast<std::int32_t>(bounds.centroid[k] - parent_centroid[k]);
    record.radius = bounds.radius;
    record.minimum_height = bounds.minimum_height;
    record.maximum_height = bounds.maximum_height;
    record.mean_normal = bounds.mean_normal;
    record.cone_half_angle = bounds.cone_half_angle;
  }

  void putErrors(NodeRecord& record, const PlannedNode& node, const NodeFacts& facts) const {
    if (node.level == 0 || facts.summary.bounds.empty) {
      record.geometric_error = record.coverage_error = record.rms_error = 0;
      return;
    }
    // A node that draws nothing has no error that could be bounded.
    if (facts.summary.facets == 0) return;
    const double slack = betweenPostsSlack(geometry_, node.level, steepest_) / kErrorUnit;
    const double error = std::ceil(static_cast<double>(facts.maximum_error) + slack);
    if (error < static_cast<double>(kUnknownError))
      record.geometric_error = static_cast<std::uint32_t>(error);
    if (facts.compared_posts > 0) {
      const double rms = std::sqrt(facts.sum_of_squares / static_cast<double>(facts.compared_posts));
      record.rms_error =
          static_cast<std::uint32_t>(std::min(std::round(rms), static_cast<double>(kUnknownError - 1)));
    }
  }

  // The grid's and the area's cluster: no data, all children's bounds.
  NodeRecord clusterRecord(std::uint8_t level, std::uint32_t first_child) const {
    NodeRecord record;
    record.type = NodeType::kCluster;
    record.level = level;
    record.first_child = first_child;
    record.geometric_error = record.coverage_error = record.rms_error = kUnknownError;
    putBounds(record, grid_bounds_, grid_bounds_.centroid);
    return record;
  }

  Status writeNodes(Publication& publication) {
    std::vector<NodeRecord> records;
    records.reserve(plan_.nodes.size() + 2);
    NodeRecord area = clusterRecord(kAreaLevel, 2);
    area.minimum_height =
        static_cast<std::int32_t>(std::floor(geometry_.metres(grid_bounds_.minimum_height)));
    area.maximum_height = static_cast<std::int32_t>(std::ceil(geometry_.metres(grid_bounds_.maximum_height)));
    records.push_back(area);
    records.push_back(clusterRecord(static_cast<std::uint8_t>(plan_.level_count), recordNumber(0)));
    for (std::size_t i = 0; i < plan_.nodes.size(); ++i) records.push_back(recordOf(i));

    const std::string name = fmt::format("nodes-{:06}.dzn", publication.generation());
    DELTAZ_TRY_ASSIGN(ContainerWriter writer,
                      ContainerWriter::create(files_, publication.newFilePath(name), ContentKind::kNodes));
    for (std::size_t first = 0; first < records.size(); first += kNodesPerPage) {
      const std::span<const NodeRecord> page =
          std::span(records).subspan(first, std::min<std::size_t>(kNodesPerPage, records.size() - first));
      DELTAZ_TRY_ASSIGN([[maybe_unused]] const std::uint32_t block,
                        writer.append(BlockType::kNodePage, encodeNodePage(page)));
    }
    DELTAZ_TRY_ASSIGN(const FileIdentity identity, writer.finish());
    area_.files.insert(area_.files.begin(), {FileRole::kNodes, 0, name, identity.length, identity.id});
    area_.node_count = static_cast<std::uint32_t>(records.size());
    area_.nodes_per_page = kNodesPerPage;
    return Success{};
  }

  void describeArea() {
    area_.west = geometry_.longitude(header_.x_axis.first);
    area_.east = geometry_.longitude(header_.x_axis.first + header_.x_axis.count - 1);
    area_.south = geometry_.latitude(header_.y_axis.first);
    area_.north = geometry_.latitude(header_.y_axis.first + header_.y_axis.count - 1);
    area_.centroid = grid_bounds_.centroid;
    area_.lowest_height = geometry_.metres(grid_bounds_.minimum_height);
    area_.highest_height = geometry_.metres(grid_bounds_.maximum_height);
    area_.sea_drop = chordSag();
    area_.grids = {header_};
    area_.tool_version = fmt::format("deltaz {}", version());
    area_.options = {{"leaf", std::to_string(header_.leaf_cells)}};
  }

  // How far the middle of the coarsest cell's diagonal lies below its ends, metres.
  double chordSag() const {
    constexpr double kRadians = std::numbers::pi / 180.0;
    const double scale = static_cast<double>(std::int64_t{1} << (plan_.level_count - 1)) * kRadians;
    const double angle =
        std::hypot(header_.x_axis.spacing, header_.y_axis.spacing) * scale;
    const double distance =
        header_.ellipsoid.semi_major_axis + std::abs(geometry_.metres(grid_bounds_.maximum_height));
    return std::ceil(distance * (1.0 - std::cos(std::min(angle / 2, std::numbers::pi / 2))) / kErrorUnit) *
           kErrorUnit;
  }

  BuildSummary summary() const {
    BuildSummary result;
    result.nodes = area_.node_count;
    result.levels = plan_.level_count;
    result.posts = grid_.heights.size();
    result.voids =
        static_cast<std::uint64_t>(std::count(grid_.valid.begin(), grid_.valid.end(), std::uint8_t{0}));
    for (const FileReference& file : area_.files) result.bytes += file.length;
    result.bytes += serializeArea(area_).size();
    const int top_level = plan_.level_count - 1;
    for (std::size_t i = levelBegin(top_level); i < levelEnd(top_level); ++i) {
      result.largest_error =
          std::max(result.largest_error, static_cast<double>(facts_[i].maximum_error) * kErrorUnit);
    }
    return result;
  }

  const FileSystem& files_;
  const RawGrid& grid_;
  const BuildOptions& options_;
  GridHeader header_;
  GridGeometry geometry_;
  tbb::task_arena arena_;
  PyramidPlan plan_;
  std::vector<NodeFacts> facts_;
  std::vector<double> steepest_;
  NodeBounds grid_bounds_;
  AreaHeader area_;
};

}  // namespace

Result<BuildSummary> buildTerrain(const FileSystem& files, const RawGrid& grid, const std::string& target,
                                  const BuildOptions& options) {
  if (options.leaf_cells < 8 || options.leaf_cells > static_cast<int>(kMaximumLeafCells) ||
      !std::has_single_bit(static_cast<unsigned>(options.leaf_cells))) {
    return usageError("--leaf", fmt::format("{} cells", options.leaf_cells),
                      "a leaf has a power of two of cells a side, from 8 to 1024");
  }
  try {
    return TerrainBuild(files, grid, options).run(target);
  } catch (const std::bad_alloc&) {
    return accessError(target, "cannot build the database", "there is not enough memory");
  } catch (const std::exception& exception) {
    return internalError(target, exception.what());
  }
}

}  // namespace deltaz
