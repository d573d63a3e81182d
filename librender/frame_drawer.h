// Draws what a frame's schedules chose: reads, transforms, stitches and tiles it, terrain before models, in
// batches from front to back.
//
// The batches follow from the schedule alone, so that picture and statistics depend on no timing. Runs on the
// threads of the caller's TBB arena. Errors: whatever reading reports; of several the first node's.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <unordered_map>
#include <vector>

#include "formats/error.h"
#include "librender/frame_scratch.h"
#include "librender/objects/border_stitcher.h"
#include "librender/objects/terrain_object_processor.h"
#include "librender/occlusion.h"
#include "librender/raster/pretiler.h"
#include "librender/scene/environment.h"
#include "librender/scene/model_tree_processor.h"
#include "librender/scene/scheduler.h"
#include "librender/scene/seam_index.h"
#include "librender/scene/stopwatch.h"

namespace deltaz {

// What is saved of nodes that nearer ground hides.
enum class HiddenNodes : std::uint8_t {
  kDrawn,      // nothing
  kNotRead,    // the whole cut is made first, and its nodes are tested
  kNotOpened,  // the cut is made as far as what is drawn lets one see
};

class FrameDrawer {
 public:
  // Refers to all of them. Adds to `statistics` what it does. `environment` and `options` are those of the
  // sample grid (antialias/sample_grid.h).
  FrameDrawer(const Database& database, const SeamIndex& seams, const Environment& environment,
              const RenderOptions& options, FrameScratch& scratch, FrameStatistics& statistics,
              Stopwatch& watch);

  // Draws what the scheduler finds; anew if that contradicts itself.
  Status drawTerrain(Scheduler& scheduler, HiddenNodes hidden);
  // After the terrain. With `occlusion` parts that ground hides are neither read nor drawn.
  Status drawModels(const ModelSchedule& models, bool occlusion);
  // After all drawing. Refers to the scratch.
  const TiledFrame& settle();
  // The nodes that were drawn, by SeenFace::node.
  const std::vector<PretiledNode>& nodes() const { return pretiled_; }

 private:
  // A node as the object processor made it.
  struct TerrainNode {
    TerrainTile tile;
    TerrainVertices vertices;
  };
  // Draws nodes of the scheduler's cut, nearest first, but for those that are hidden when their batch comes.
  Status drawPart(Scheduler& scheduler, std::span<const std::uint32_t> nodes, HiddenNodes hidden);
  void drawBatch(const std::vector<CutNode>& cut, const BorderStitcher& stitcher,
                 const std::vector<ProcessedNode>& processed, std::span<const std::uint32_t> nodes);
  void drawNothing();
  double leafSide() const;
  // Reads and transforms those of the nodes that are not at hand yet.
  Status process(const std::vector<CutNode>& cut, const std::vector<std::uint32_t>& wanted,
                 std::vector<ProcessedNode>& processed);
  // Calls make(n) for n = 0 .. count - 1, each of which returns a node to be drawn and its counts, and draws
  // these.
  struct Made {
    PretiledNode node;
    std::uint64_t in = 0, back_facing = 0;
  };
  void drawNodes(std::size_t count, const std::function<Made(std::size_t)>& make);
  TileBins& nextBins();

  const Database& database_;
  const SeamIndex& seams_;
  const Environment& environment_;
  const RenderOptions& options_;
  FrameScratch& scratch_;
  FrameStatistics& statistics_;
  Stopwatch& watch_;
  const SampleOffsets* offsets_;
  Pretiler pretiler_;
  Occlusion occlusion_;
  std::unordered_map<std::uint32_t, std::unique_ptr<TerrainNode>> terrain_;  // by record
  std::vector<PretiledNode> pretiled_;                                       // as they are drawn
  std::size_t bins_used_ = 0;
};

}  // namespace deltaz
