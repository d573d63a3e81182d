#include "librender/scene/scheduler.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "librender/scene/horizon.h"
#include "librender/scene/normal_cone.h"
#include "librender/scene/projected_error.h"
#include "librender/scene/strip_error.h"
#include "librender/scene/view_volume.h"

namespace deltaz {
namespace {

class Scheduler {
 public:
  Scheduler(const Database& database, const SeamIndex& seams, const ViewTransform& view,
            const ScheduleOptions& options, FrameStatistics::Nodes& statistics)
      : database_(database),
        seams_(seams),
        view_(view),
        options_(options),
        statistics_(statistics),
        view_volume_(view, options.tolerance),
        horizon_(database.area(), view.eye) {}

  Result<Schedule> run() {
    DELTAZ_TRY_ASSIGN(const Node root, database_.root());
    std::vector<Node> waiting = {root};
    DELTAZ_TRY(refine(waiting));
    if (options_.fixed_level < 0 && options_.test_strips) DELTAZ_TRY(refineBesideStrips());
    return finish();
  }

 private:
  // Error bounds of what the node itself draws, in pixels. Coverage errors lie in plan, in any direction.
  double ownError(const CutNode& candidate) const {
    const Node& node = candidate.node;
    if (node.record.level == 0) return 0;
    return std::max(projectedHeightErrorBound(view_, candidate.volume, node.geometricError()),
                    projectedErrorBound(view_, candidate.volume, node.coverageError()));
  }

  bool isFineEnough(const CutNode& candidate) const {
    const Node& node = candidate.node;
    if (node.record.type != NodeType::kTerrain) return false;
    if (node.record.level == 0) return true;
    // In view or not: what is in view may stand on its posts.
    if (candidate.seamed) return false;
    if (options_.fixed_level >= 0) return node.record.level <= options_.fixed_level;
    if (!candidate.in_view) return true;
    return options_.tolerance > 0 && ownError(candidate) <= options_.tolerance;
  }

  // False, and counted, if nothing of the node can be seen.
  bool maySee(const CutNode& candidate) {
    if (view_volume_.isOutside(candidate.volume)) {
      ++statistics_.out_of_view;
      return false;
    }
    if (horizon_.hides(candidate.volume)) {
      ++statistics_.beyond_horizon;
      return false;
    }
    if (facesAway(candidate.node, view_.eye)) {
      ++statistics_.facing_away;
      return false;
    }
    return true;
  }

  // Replaces the waiting nodes by what is fine enough below them, and appends that to the cut.
  Status refine(std::vector<Node>& waiting) {
    while (!waiting.empty()) {
      const Node parent = waiting.back();
      waiting.pop_back();
      DELTAZ_TRY_ASSIGN(const std::vector<Node> children, database_.children(parent));
      for (const Node& child : children) {
        ++statistics_.visited;
        if (child.record.isEmpty()) continue;
        const bool terrain = child.record.type == NodeType::kTerrain;
        if (!terrain && child.record.type != NodeType::kCluster) continue;
        const SeamState seam = terrain ? seams_.stateOf(positionOf(child.record)) : SeamState::kFree;
        if (seam == SeamState::kRemoved) continue;
        CutNode candidate{child, true};
        candidate.seamed = seam == SeamState::kTouched;
        if (terrain) {
          candidate.volume = volumeOf(child, database_.grid(child.record.grid), !candidate.seamed);
          candidate.in_view = !options_.cull || maySee(candidate);
        }
        if (isFineEnough(candidate)) {
          nodes_.push_back(candidate);
        } else {
          waiting.push_back(child);
        }
      }
    }
    return Success{};
  }

  // Refines coarser neighbours until every strip in view is good enough. A child's error may exceed its
  // parent's, so all strips are looked at again after each round; every round refines, so rounds end.
  Status refineBesideStrips() {
    for (;;) {
      const CutIndex index(database_, nodes_);
      const StripErrors strips(database_, nodes_, index);
      std::vector<bool> refined(nodes_.size(), false);
      bool any = false;
      for (std::uint32_t n = 0; n < nodes_.size(); ++n) {
        if (!nodes_[n].in_view) continue;
        std::uint32_t coarser = CutIndex::kNone;
        const double added = strips.strip(n, coarser);
        if (coarser == CutIndex::kNone ||
            (options_.tolerance > 0 && stripError(n, added) <= options_.tolerance))
          continue;
        refined[coarser] = true;
        any = true;
      }
      if (!any) return Success{};
      std::vector<Node> waiting;
      std::vector<CutNode> kept;
      for (std::size_t n = 0; n < nodes_.size(); ++n) {
        if (refined[n]) {
          waiting.push_back(nodes_[n].node);
        } else {
          kept.push_back(std::move(nodes_[n]));
        }
      }
      nodes_ = std::move(kept);
      DELTAZ_TRY(refine(waiting));
    }
  }

  double stripError(std::uint32_t n, double added) const {
    const Node& node = nodes_[n].node;
    const double own = node.record.level == 0 ? 0 : node.geometricError();
    return projectedHeightErrorBound(view_, nodes_[n].volume, own + added);
  }

  Schedule finish() {
    std::sort(nodes_.begin(), nodes_.end(),
              [](const CutNode& a, const CutNode& b) { return a.node.number < b.node.number; });
    Schedule schedule;
    const CutIndex index(database_, nodes_);
    const StripErrors strips(database_, nodes_, index);
    bool first = true;
    for (std::uint32_t n = 0; n < nodes_.size(); ++n) {
      if (!nodes_[n].in_view) continue;
      const int level = nodes_[n].node.record.level;
      schedule.level = first ? level : std::min(schedule.level, level);
      schedule.coarsest_level = std::max(schedule.coarsest_level, level);
      first = false;
      ++statistics_.drawn;
      std::uint32_t coarser = CutIndex::kNone;
      const double added = strips.strip(n, coarser);
      schedule.projected_error = std::max({schedule.projected_error, ownError(nodes_[n]),
                                           coarser == CutIndex::kNone ? 0 : stripError(n, added)});
    }
    schedule.nodes = std::move(nodes_);
    schedule.front_to_back = frontToBack(schedule.nodes);
    return schedule;
  }

  std::vector<std::uint32_t> frontToBack(const std::vector<CutNode>& nodes) const {
    std::vector<std::pair<double, std::uint32_t>> by_distance;
    for (std::uint32_t n = 0; n < nodes.size(); ++n) {
      if (!nodes[n].in_view) continue;
      by_distance.emplace_back(leastDistance(nodes[n].volume, view_.eye), n);
    }
    std::sort(by_distance.begin(), by_distance.end());
    std::vector<std::uint32_t> order;
    order.reserve(by_distance.size());
    for (const auto& [distance, n] : by_distance) order.push_back(n);
    return order;
  }

  const Database& database_;
  const SeamIndex& seams_;
  const ViewTransform& view_;
  const ScheduleOptions& options_;
  FrameStatistics::Nodes& statistics_;
  // A border that follows coarser edges lies up to the tolerance beside the finer node that is to meet it: so
  // much more than the picture is in view.
  ViewVolume view_volume_;
  Horizon horizon_;
  std::vector<CutNode> nodes_;
};

}  // namespace

Result<Schedule> scheduleNodes(const Database& database, const SeamIndex& seams, const ViewTransform& view,
                               const ScheduleOptions& options, FrameStatistics::Nodes& statistics) {
  return Scheduler(database, seams, view, options, statistics).run();
}

}  // namespace deltaz
