// Chooses what is drawn: a cut through the area's quadtrees in which every node in view has errors that
// project to no more than the tolerance, whatever the levels of its neighbours.
//
// A node is refined while its geometric or its coverage error projects to more than the tolerance, and while
// the eye is inside its bounding volume and its error is not zero. Nodes that cannot be seen, because they
// are out of view, below the horizon or turned away, stay as they are. A node of which no quarter can be
// seen, though the node might, is refined, to be culled by what is below it (scene/split_cost.h). Where two
// levels meet, the finer node's border follows the coarser one's edges (objects/border_stitcher.h), so along
// that strip both levels' errors add: the coarser node is refined until the sum projects to no more than the
// tolerance, too. Neighbours may differ by any number of levels.
//
// The cut may be made from near to far, so that what is drawn of it tells what need not be opened
// (Scheduler).
//
// Reads only the node pages of nodes in the cut and of their siblings. Thread-safety: pure functions; a
// Scheduler is one thread's.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <unordered_set>
#include <vector>

#include "formats/error.h"
#include "libdb/access/database.h"
#include "librender/scene/cut.h"
#include "librender/scene/horizon.h"
#include "librender/scene/projected_error.h"
#include "librender/scene/render.h"
#include "librender/scene/seam_index.h"
#include "librender/scene/strip_error.h"
#include "librender/scene/view_volume.h"

namespace deltaz {

struct Schedule {
  int level = 0, coarsest_level = 0;  // of the nodes drawn
  double projected_error = 0;         // pixels: the largest bound of what is drawn, strips included
  FrameStatistics::FullResolution full_resolution;
  // The cut, in the order of the record numbers. It covers all of the area that has heights, but for what
  // lies under other grids.
  std::vector<CutNode> nodes;
  // Indices into `nodes` of those drawn, nearest first: by the least distance between the eye and the node's
  // volume, those equally near by record number. Nothing a node draws is nearer than that distance.
  std::vector<std::uint32_t> front_to_back;
};

struct ScheduleOptions {
  double tolerance = 1;  // pixels; 0 for full resolution
  int fixed_level = -1;  // >= 0: this level everywhere (at most the coarsest)
  // For tests that must see the contract fail: leaves the strips untested.
  bool test_strips = true;
  // For tests of culling: false takes everything for seen.
  bool cull = true;
  // For tests and benchmarks of the same: false opens nothing only because fewer triangles are left below it.
  bool look_below = true;
};

// Counts in `statistics` the nodes visited, those not opened because nothing of them can be seen (by the
// first reason that was found), and those drawn. Nodes that `seams` touch are drawn at full resolution,
// whatever the tolerance.
Result<Schedule> scheduleNodes(const Database& database, const SeamIndex& seams, const ViewTransform& view,
                               const ScheduleOptions& options, FrameStatistics::Nodes& statistics);

// Makes the cut step by step. A step opens what is nearer than some distance and not hidden, and says what of
// the cut can be drawn: nodes around which nothing will change, because whatever is still waiting is some
// nodes away. Strips may carry a change across any number of nodes, if each must be refined for the one
// before; if that reaches what is drawn, or what its border follows, contradicted() becomes true, and the
// frame must be drawn anew, with what was too coarse opened from the start.
class Scheduler {
 public:
  // True only if what is drawn so far hides all of the volume.
  using Hides = std::function<bool(const NodeVolume&)>;

  // Refers to all of them, as scheduleNodes does.
  Scheduler(const Database& database, const SeamIndex& seams, const ViewTransform& view,
            const ScheduleOptions& options, FrameStatistics::Nodes& statistics);

  // Looks as far as `farthest` metres, which may be infinity. `hides` may be empty.
  Status advance(double farthest, const Hides& hides);
  // Whether all has been looked at; else, how near the nearest thing is that has not.
  bool complete() const;
  double nearestWaiting() const;
  bool contradicted() const { return contradicted_; }
  // Forgets all but what must be opened; the counts are zero again.
  void restart();

  // Valid until the next advance().
  const std::vector<CutNode>& cut() const { return nodes_; }
  // Indices into the cut of those that can be drawn and are neither drawn nor hidden, nearest first.
  std::vector<std::uint32_t> ready() const;
  // What became of nodes that were ready.
  void setDrawn(std::span<const std::uint32_t> nodes);
  void setOccluded(std::uint32_t node);

  // The schedule of all that was drawn, or is ready. Ends the scheduler's use.
  Schedule finish();

 private:
  // What is known of the strip along a node's border.
  struct Strip {
    bool known = false;
    double pixels = 0;                   // the bound of its error; 0 if no neighbour is coarser
    std::vector<std::uint32_t> depends;  // numbers of the records it follows from
  };

  double ownError(const CutNode& candidate) const;
  bool isFineEnough(const CutNode& candidate) const;
  bool drawsFewerOpened(const CutNode& candidate) const;
  bool maySee(CutNode& candidate);
  void look(CutNode& candidate);
  Status refine(std::vector<Node>& waiting);
  Status lookFarther();
  std::uint32_t weighStrip(const StripErrors& strips, std::uint32_t n);
  Status refineBesideStrips();
  void remove(const std::unordered_set<std::uint32_t>& removed,
              const std::unordered_set<std::uint32_t>& changed);
  std::vector<std::uint32_t> bordersOf(const CutIndex& index, std::uint32_t node) const;
  void countTriangles(const CutNode& node, FrameStatistics::FullResolution& counts) const;
  void sortFrontToBack(std::vector<std::uint32_t>& nodes) const;

  const Database& database_;
  const SeamIndex& seams_;
  const ViewTransform& view_;
  ScheduleOptions options_;
  FrameStatistics::Nodes& statistics_;
  // A border that follows coarser edges lies up to the tolerance beside the finer node that is to meet it: so
  // much more than the picture is in view.
  ViewVolume view_volume_;
  Horizon horizon_;
  double farthest_ = 0;
  Hides hides_;
  bool begun_ = false, contradicted_ = false;
  std::unordered_set<std::uint32_t> must_open_;  // numbers of records
  std::vector<CutNode> nodes_;
  std::vector<Strip> strips_;           // of nodes_, as far as they are known
  std::vector<std::uint32_t> touched_;  // of the strip that is looked at
};

}  // namespace deltaz
