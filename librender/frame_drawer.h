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
#include "librender/raster/pretiler.h"
#include "librender/scene/environment.h"
#include "librender/scene/model_tree_processor.h"
#include "librender/scene/scheduler.h"
#include "librender/scene/seam_index.h"
#include "librender/scene/stopwatch.h"

namespace deltaz {

class FrameDrawer {
 public:
  // Refers to all of them. Adds to `statistics` what it does. `environment` and `options` are those of the
  // sample grid (antialias/sample_grid.h).
  FrameDrawer(const Database& database, const SeamIndex& seams, const Environment& environment,
              const RenderOptions& options, FrameScratch& scratch, FrameStatistics& statistics,
              Stopwatch& watch);

  Status drawTerrain(const Schedule& schedule);
  Status drawModels(const ModelSchedule& models);
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
  // Reads and transforms those of the nodes that are not at hand yet.
  Status process(const std::vector<CutNode>& cut, const std::vector<std::uint32_t>& wanted,
                 std::vector<ProcessedNode>& processed);
  // Calls make(n) for n = 0 .. count - 1, each of which returns a node to be drawn and its counts, and draws
  // these.
  struct Made {
    PretiledNode node;
    std::uint64_t in = 0, back_facing = 0;
  };
  void drawBatch(std::size_t count, const std::function<Made(std::size_t)>& make);
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
  std::unordered_map<std::uint32_t, std::unique_ptr<TerrainNode>> terrain_;  // by record
  std::vector<PretiledNode> pretiled_;                                       // as they are drawn
  std::size_t bins_used_ = 0;
};

}  // namespace deltaz
