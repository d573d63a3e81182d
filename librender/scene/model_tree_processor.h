// The model tree processor (report 5.7, Table 16): which parts of which placed models are drawn, at which
// level of detail, and where they stand.
//
// A breadth-first queue of pages of placements, placements and parts. What is out of the view volume by its
// sphere is dropped with all under it; a page that is dropped is not read. The matrices of a part (its own
// motion, its default transform, its parent's) are concatenated once for all instances that stand alike. A
// part's level of detail is the coarsest whose error projects to no more than the tolerance.
//
// Of Table 16 corrected: children are enqueued whether or not their parent has data of its own, so that a
// part that only carries others does not block them. A part that has moved may have left the spheres stored
// for it as it stands by default; those of moved models are made anew, and those of pages grown by as much.
//
// Errors: whatever reading pages and posedTree report. Thread-safety: pure functions.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "formats/error.h"
#include "formats/placement_file.h"
#include "libdb/access/database.h"
#include "librender/scene/camera.h"
#include "librender/scene/pose_table.h"
#include "librender/scene/render.h"

namespace deltaz {

// What the processor walks through. Refers to the database it was made of.
struct ModelScene {
  EllipsoidShape ellipsoid;
  std::vector<const ModelTree*> trees;  // of the models, by number
  std::vector<PlacementSphere> pages;
  std::function<Result<std::vector<Placement>>(std::uint32_t page)> read_page;
};

ModelScene modelSceneOf(const Database& database);

struct ModelTreeOptions {
  double tolerance = 1;  // pixels; 0 for the finest
  int fixed_level = -1;  // >= 0: this level, or the coarsest a part has
  bool cull = true;      // for tests of culling: false keeps everything
};

struct DrawnPart {
  std::uint32_t instance = 0;
  std::uint32_t model = 0, part = 0;  // numbers
  std::uint32_t lod = 0;              // index into the part's levels of detail
  ModelTransform to_earth{};          // part's space -> Earth-centred metres
  Vector3 centre;                     // of a sphere around what it shows, Earth-centred
  double radius = 0;                  // metres
};

struct ModelSchedule {
  std::vector<DrawnPart> parts;  // in the order of instances, then parts
  double projected_error = 0;    // pixels: the largest bound of what is drawn
};

Result<ModelSchedule> processModelTrees(const ModelScene& scene, const PoseTable& poses,
                                        const ViewTransform& view, const ModelTreeOptions& options,
                                        FrameStatistics::Models& statistics);

}  // namespace deltaz
