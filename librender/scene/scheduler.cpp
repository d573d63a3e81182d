#include "librender/scene/scheduler.h"

#include <algorithm>
#include <optional>
#include <unordered_set>
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
        const bool terrain = child.record.type == NodeType::kTerrain;
        const SeamState seam = terrain ? seams_.stateOf(positionOf(child.record)) : SeamState::kFree;
        if (child.record.isEmpty() || (!terrain && child.record.type != NodeType::kCluster) ||
            seam == SeamState::kRemoved) {
          ++statistics_.empty;
          continue;
        }
        CutNode candidate{child, true};
        candidate.seamed = seam == SeamState::kTouched;
        if (terrain) {
          candidate.volume = volumeOf(child, database_.grid(child.record.grid), !candidate.seamed);
          candidate.in_view = !options_.cull || maySee(candidate);
        }
        if (isFineEnough(candidate)) {
          nodes_.push_back(candidate);
        } else {
          // One that cannot be seen is counted as that, even if others stand on its posts.
          if (candidate.in_view) ++statistics_.opened;
          waiting.push_back(child);
        }
      }
    }
    return Success{};
  }

  // What is known of the strip along a node's border.
  struct Strip {
    bool known = false;
    double pixels = 0;                   // the bound of its error; 0 if no neighbour is coarser
    std::vector<std::uint32_t> depends;  // numbers of the records it follows from
  };

  // The coarser node that contributes most, as an index of nodes_; kNone if there is none.
  std::uint32_t weighStrip(const StripErrors& strips, std::uint32_t n) {
    std::uint32_t coarser = CutIndex::kNone;
    const double added = strips.strip(n, coarser, &touched_);
    Strip& strip = strips_[n];
    strip.known = true;
    strip.pixels = 0;
    if (coarser != CutIndex::kNone) {
      const Node& node = nodes_[n].node;
      const double own = node.record.level == 0 ? 0 : node.geometricError();
      strip.pixels = projectedHeightErrorBound(view_, nodes_[n].volume, own + added);
    }
    strip.depends.clear();
    for (const std::uint32_t other : touched_) strip.depends.push_back(nodes_[other].node.number);
    return coarser;
  }

  // Refines coarser neighbours until every strip in view is good enough. A child's error may exceed its
  // parent's, so strips beside what was refined are looked at again; every round refines, so rounds end.
  Status refineBesideStrips() {
    for (;;) {
      strips_.resize(nodes_.size());
      const CutIndex index(database_, nodes_);
      const StripErrors strips(database_, nodes_, index);
      std::unordered_set<std::uint32_t> refined;  // record numbers
      for (std::uint32_t n = 0; n < nodes_.size(); ++n) {
        if (!nodes_[n].in_view || strips_[n].known) continue;
        const std::uint32_t coarser = weighStrip(strips, n);
        if (coarser == CutIndex::kNone || (options_.tolerance > 0 && strips_[n].pixels <= options_.tolerance))
          continue;
        refined.insert(nodes_[coarser].node.number);
      }
      if (refined.empty()) return Success{};
      std::vector<Node> waiting;
      std::size_t kept = 0;
      for (std::size_t n = 0; n < nodes_.size(); ++n) {
        if (refined.contains(nodes_[n].node.number)) {
          if (nodes_[n].in_view) ++statistics_.opened;
          waiting.push_back(nodes_[n].node);
          continue;
        }
        Strip& strip = strips_[n];
        strip.known =
            strip.known && std::none_of(strip.depends.begin(), strip.depends.end(),
                                        [&](std::uint32_t other) { return refined.contains(other); });
        if (kept != n) {
          nodes_[kept] = nodes_[n];
          strips_[kept] = std::move(strip);
        }
        ++kept;
      }
      nodes_.resize(kept);
      strips_.resize(kept);
      DELTAZ_TRY(refine(waiting));
    }
  }

  Schedule finish() {
    Schedule schedule;
    strips_.resize(nodes_.size());
    std::optional<CutIndex> index;
    std::optional<StripErrors> strips;
    bool first = true;
    for (std::uint32_t n = 0; n < nodes_.size(); ++n) {
      if (!nodes_[n].in_view) continue;
      const int level = nodes_[n].node.record.level;
      schedule.level = first ? level : std::min(schedule.level, level);
      schedule.coarsest_level = std::max(schedule.coarsest_level, level);
      first = false;
      ++statistics_.drawn;
      if (!strips_[n].known) {
        // Strips were not to be tested.
        if (!strips) strips.emplace(database_, nodes_, index.emplace(database_, nodes_));
        weighStrip(*strips, n);
      }
      schedule.projected_error = std::max({schedule.projected_error, ownError(nodes_[n]), strips_[n].pixels});
    }
    std::sort(nodes_.begin(), nodes_.end(),
              [](const CutNode& a, const CutNode& b) { return a.node.number < b.node.number; });
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
  std::vector<Strip> strips_;           // of nodes_, as far as they are known
  std::vector<std::uint32_t> touched_;  // of the strip that is looked at
};

}  // namespace

Result<Schedule> scheduleNodes(const Database& database, const SeamIndex& seams, const ViewTransform& view,
                               const ScheduleOptions& options, FrameStatistics::Nodes& statistics) {
  return Scheduler(database, seams, view, options, statistics).run();
}

}  // namespace deltaz
