#include "librender/frame_drawer.h"

#include <algorithm>
#include <limits>
#include <optional>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>
#include <unordered_set>
#include <utility>

#include "libdb/access/plan_shape.h"
#include "librender/objects/grid_faces.h"
#include "librender/objects/model_object_processor.h"
#include "librender/objects/part_meshes.h"
#include "librender/objects/report_objects.h"
#include "librender/objects/transform_error_bound.h"

namespace deltaz {
namespace {

// Nodes of the first batch. What a batch hides is not read, and every batch waits for all of the one before:
// each is as large as all before it.
constexpr std::size_t kFirstBatch = 16;

// How far the scheduler looks first, in sides of a leaf, and how many times as far at the next step.
constexpr double kFirstLeaves = 6, kStep = 2;

// Of drawing the terrain step by step; the last one makes the whole cut at once.
constexpr int kMostAttempts = 5;

}  // namespace

FrameDrawer::FrameDrawer(const Database& database, const SeamIndex& seams, const Environment& environment,
                         const RenderOptions& options, FrameScratch& scratch, FrameStatistics& statistics,
                         Stopwatch& watch)
    : database_(database),
      seams_(seams),
      environment_(environment),
      options_(options),
      scratch_(scratch),
      statistics_(statistics),
      watch_(watch),
      offsets_(sampleOffsets(options.sampling.count, options.sampling.pattern)),
      pretiler_(environment.view, offsets_ == nullptr ? 0 : offsets_->reach),
      occlusion_(scratch.tiler, environment.view, options.tolerance,
                 offsets_ == nullptr ? 0 : static_cast<double>(offsets_->reach) / kSubPixels) {
  drawNothing();
}

void FrameDrawer::drawNothing() {
  scratch_.tiler.begin(environment_.view.width, environment_.view.height, offsets_);
  pretiled_.clear();
  bins_used_ = 0;
}

TileBins& FrameDrawer::nextBins() {
  if (bins_used_ == scratch_.bins.size()) scratch_.bins.push_back(std::make_unique<TileBins>());
  TileBins& bins = *scratch_.bins[bins_used_++];
  bins.reset(environment_.view.width, environment_.view.height,
             static_cast<std::size_t>(tbb::this_task_arena::max_concurrency()));
  return bins;
}

void FrameDrawer::drawNodes(std::size_t count, const std::function<Made(std::size_t)>& make) {
  const std::size_t first = pretiled_.size();
  pretiled_.resize(first + count);
  std::vector<FrameStatistics::Triangles> of_node(count);
  TileBins& bins = nextBins();
  tbb::parallel_for(std::size_t{0}, count, [&](std::size_t n) {
    Made made = make(n);
    PretiledNode& node = pretiled_[first + n];
    node = std::move(made.node);
    const auto number = static_cast<std::uint32_t>(first + n);
    TileBins::Writer& writer =
        bins.writer(static_cast<std::size_t>(tbb::this_task_arena::current_thread_index()));
    writer.begin(number);
    pretiler_.process(node, number, writer);
    of_node[n] = {made.in, made.back_facing, node.clipped, node.no_sample, 0};
  });
  bins.finish();
  for (const FrameStatistics::Triangles& counts : of_node) {
    statistics_.triangles.in += counts.in;
    statistics_.triangles.back_facing += counts.back_facing;
    statistics_.triangles.clipped += counts.clipped;
    statistics_.triangles.no_sample += counts.no_sample;
  }
  statistics_.milliseconds.objects += watch_.lap();
  scratch_.tiler.draw(bins);
  statistics_.milliseconds.raster += watch_.lap();
}

Status FrameDrawer::process(const std::vector<CutNode>& cut, const std::vector<std::uint32_t>& wanted,
                            std::vector<ProcessedNode>& processed) {
  std::vector<std::uint32_t> missing;
  for (const std::uint32_t n : wanted) {
    if (processed[n].tile != nullptr) continue;
    const auto found = terrain_.find(cut[n].node.number);
    if (found == terrain_.end()) {
      missing.push_back(n);
    } else {
      processed[n] = {&found->second->tile, &found->second->vertices};
    }
  }
  std::vector<std::optional<Result<TerrainTile>>> read(missing.size());
  tbb::parallel_for(std::size_t{0}, missing.size(),
                    [&](std::size_t m) { read[m].emplace(database_.terrain(cut[missing[m]].node)); });
  for (const std::optional<Result<TerrainTile>>& tile : read) {
    if (!tile->ok()) return tile->error();
    statistics_.posts_decoded +=
        static_cast<std::uint64_t>(tile->value().columns) * static_cast<std::uint64_t>(tile->value().rows);
  }
  statistics_.milliseconds.read += watch_.lap();

  std::vector<std::unique_ptr<TerrainNode>> made(missing.size());
  std::vector<double> error(missing.size(), 0);
  tbb::parallel_for(std::size_t{0}, missing.size(), [&](std::size_t m) {
    made[m] = std::make_unique<TerrainNode>();
    TerrainNode& node = *made[m];
    node.tile = std::move(*read[m]).value();
    const GridGeometry& grid = database_.grid(node.tile.grid);
    node.vertices =
        terrainVertices(node.tile, grid, environment_.view, environment_.light, options_.transform);
    // Pixels that a transform other than exact may add. A face at a border takes posts of its neighbours, so
    // all processed nodes count.
    if (options_.transform != TransformKind::kExact) {
      const double bound = transformErrorBound(options_.transform, node.tile, grid, environment_.view);
      error[m] = transformPixelBound(bound, node.tile, node.vertices.position, environment_.view);
    }
  });
  for (std::size_t m = 0; m < missing.size(); ++m) {
    processed[missing[m]] = {&made[m]->tile, &made[m]->vertices};
    terrain_.emplace(cut[missing[m]].node.number, std::move(made[m]));
    statistics_.transform_error = std::max(statistics_.transform_error, error[m]);
  }
  statistics_.milliseconds.objects += watch_.lap();
  return Success{};
}

Status FrameDrawer::drawTerrain(Scheduler& scheduler, HiddenNodes hidden) {
  const FrameStatistics::Triangles before = statistics_.triangles;
  const Scheduler::Hides hides = [this](const NodeVolume& volume) { return occlusion_.hides(volume); };
  for (int attempt = 1;; ++attempt) {
    if (attempt == kMostAttempts && hidden == HiddenNodes::kNotOpened) hidden = HiddenNodes::kNotRead;
    double farthest = hidden == HiddenNodes::kNotOpened ? 0 : std::numeric_limits<double>::infinity();
    DELTAZ_TRY(scheduler.advance(farthest, {}));
    for (;;) {
      DELTAZ_TRY(drawPart(scheduler, scheduler.ready(), hidden));
      if (scheduler.complete()) return Success{};
      // Views from far above hide little: there one step mostly takes all.
      farthest = std::max({kStep * farthest, kStep * scheduler.nearestWaiting(), kFirstLeaves * leafSide()});
      DELTAZ_TRY(scheduler.advance(farthest, hides));
      if (scheduler.contradicted()) break;
    }
    drawNothing();
    statistics_.triangles = before;
    scheduler.restart();
  }
}

// The shortest side of a leaf, metres.
double FrameDrawer::leafSide() const {
  double side = std::numeric_limits<double>::infinity();
  for (int g = 0; g < database_.gridCount(); ++g) {
    const GridGeometry& grid = database_.grid(g);
    const CellSize cell = largestCell(grid, grid.columnsAt(0), grid.rowsAt(0));
    side = std::min(side, std::min(cell.width, cell.height) * static_cast<double>(grid.header().leaf_cells));
  }
  return side;
}

Status FrameDrawer::drawPart(Scheduler& scheduler, std::span<const std::uint32_t> nodes, HiddenNodes hidden) {
  if (nodes.empty()) return Success{};
  const std::vector<CutNode>& cut = scheduler.cut();
  const CutIndex index(database_, cut);
  std::vector<ProcessedNode> processed(cut.size());
  const BorderStitcher stitcher(database_, cut, index, seams_, processed, environment_.color_map != nullptr);
  std::vector<std::uint32_t> drawn, all;
  for (std::size_t begin = 0; begin < nodes.size();) {
    const std::size_t end = std::min(nodes.size(), std::max(kFirstBatch, 2 * begin));
    drawn.clear();
    for (; begin < end; ++begin) {
      if (hidden != HiddenNodes::kDrawn && occlusion_.hides(cut[nodes[begin]].volume)) {
        scheduler.setOccluded(nodes[begin]);
      } else {
        drawn.push_back(nodes[begin]);
      }
    }
    statistics_.milliseconds.schedule += watch_.lap();
    DELTAZ_TRY(process(cut, nodesToProcess(database_, cut, index, seams_, drawn), processed));
    drawBatch(cut, stitcher, processed, drawn);
    all.insert(all.end(), drawn.begin(), drawn.end());
  }
  scheduler.setDrawn(all);
  return Success{};
}

void FrameDrawer::drawBatch(const std::vector<CutNode>& cut, const BorderStitcher& stitcher,
                            const std::vector<ProcessedNode>& processed,
                            std::span<const std::uint32_t> nodes) {
  const bool by_range = options_.lod == LodScheme::kReport;
  std::vector<FrameStatistics::Objects> objects(by_range ? nodes.size() : 0);
  drawNodes(nodes.size(), [&](std::size_t n) {
    const std::uint32_t of_cut = nodes[n];
    const TerrainTile& tile = *processed[of_cut].tile;
    TerrainSplits splits;
    TerrainVertices stitched = stitcher.vertices(of_cut, splits);
    const std::vector<std::uint8_t> replaced = seams_.replacedFaces(tile);
    GridFaces faces;
    if (by_range) {
      faces.listed = reportFaces(tile, database_.grid(tile.grid), environment_.view, options_.report_lod,
                                 stitched.position, replaced, objects[n]);
    } else {
      faces = gridFaces(tile, stitched.position, splits, replaced);
    }
    for (const TerrainFace& face : stitcher.seamFaces(of_cut, stitched))
      addFace(faces.listed, stitched.position, face);
    Made made;
    made.in = faces.in();
    made.back_facing = faces.backFacing();
    made.node = PretiledNode::ofTerrain(cut[of_cut].node.record.grid, cut[of_cut].node.number,
                                        std::move(stitched), std::move(faces));
    return made;
  });
  for (const FrameStatistics::Objects& counts : objects) statistics_.objects += counts;
}

Status FrameDrawer::drawModels(const ModelSchedule& models, bool occlusion) {
  std::vector<DrawnPart> parts;
  std::unordered_set<std::uint32_t> in_view, drawn;  // instances
  for (const DrawnPart& part : models.parts) {
    in_view.insert(part.instance);
    if (occlusion && occlusion_.hides(part.centre, part.radius)) continue;
    drawn.insert(part.instance);
    parts.push_back(part);
  }
  statistics_.models.occluded += in_view.size() - drawn.size();
  statistics_.models.drawn -= in_view.size() - drawn.size();
  if (parts.empty()) return Success{};
  statistics_.milliseconds.schedule += watch_.lap();
  DELTAZ_TRY_ASSIGN(const PartMeshes meshes, PartMeshes::read(database_, parts));
  statistics_.milliseconds.read += watch_.lap();
  drawNodes(parts.size(), [&](std::size_t p) {
    const DrawnPart& part = parts[p];
    ModelFaces faces = modelFaces(meshes.of(p), part.to_earth, environment_.view, environment_.light);
    Made made;
    made.in = faces.in;
    made.back_facing = faces.back_facing;
    made.node = PretiledNode::ofModel(part.instance, std::move(faces));
    return made;
  });
  return Success{};
}

const TiledFrame& FrameDrawer::settle() {
  const TiledFrame& frame = scratch_.tiler.settle();
  statistics_.triangles.drawn = frame.statistics.faces_drawn;
  statistics_.triangles.no_sample += frame.statistics.no_sample;
  statistics_.triangles.hidden = frame.statistics.hidden;
  statistics_.samples.tested = frame.statistics.tested;
  statistics_.samples.written = frame.statistics.written;
  statistics_.milliseconds.raster += watch_.lap();
  return frame;
}

}  // namespace deltaz
