#include "librender/scene/scheduler.h"

#include <algorithm>
#include <limits>
#include <optional>
#include <utility>

#include "librender/scene/normal_cone.h"
#include "librender/scene/split_cost.h"

namespace deltaz {
namespace {

// What is ready lies at least so many nodes away from what is waiting.
constexpr std::uint8_t kRings = 3;

}  // namespace

Scheduler::Scheduler(const Database& database, const SeamIndex& seams, const ViewTransform& view,
                     const ScheduleOptions& options, FrameStatistics::Nodes& statistics)
    : database_(database),
      seams_(seams),
      view_(view),
      options_(options),
      statistics_(statistics),
      view_volume_(view, options.tolerance),
      horizon_(database.area(), view.eye) {}

void Scheduler::restart() {
  nodes_.clear();
  strips_.clear();
  statistics_ = {};
  begun_ = contradicted_ = false;
}

Status Scheduler::advance(double farthest, const Hides& hides) {
  farthest_ = farthest;
  hides_ = hides;
  if (begun_) {
    DELTAZ_TRY(lookFarther());
  } else {
    begun_ = true;
    DELTAZ_TRY_ASSIGN(const Node root, database_.root());
    std::vector<Node> waiting = {root};
    DELTAZ_TRY(refine(waiting));
  }
  if (options_.fixed_level < 0 && options_.test_strips) DELTAZ_TRY(refineBesideStrips());
  return Success{};
}

// Error bounds of what the node itself draws, in pixels. Coverage errors lie in plan, in any direction.
double Scheduler::ownError(const CutNode& candidate) const {
  const Node& node = candidate.node;
  if (node.record.level == 0) return 0;
  return std::max(projectedHeightErrorBound(view_, candidate.volume, node.geometricError()),
                  projectedErrorBound(view_, candidate.volume, node.coverageError()));
}

bool Scheduler::isFineEnough(const CutNode& candidate) const {
  const Node& node = candidate.node;
  if (node.record.type != NodeType::kTerrain) return false;
  if (node.record.level == 0) return true;
  // In view or not: what is in view may stand on its posts.
  if (candidate.seamed) return false;
  if (candidate.waiting) return true;
  if (candidate.in_view && must_open_.contains(node.number)) return false;
  if (options_.fixed_level >= 0) return node.record.level <= options_.fixed_level;
  if (!candidate.in_view) return true;
  return options_.tolerance > 0 && ownError(candidate) <= options_.tolerance && !drawsFewerOpened(candidate);
}

// Whether what is hidden or out of view below a node makes up for finer levels. What waits may be seen.
bool Scheduler::drawsFewerOpened(const CutNode& candidate) const {
  if (!options_.cull || !options_.look_below) return false;
  return deltaz::drawsFewerOpened(
      candidate.node, database_.grid(candidate.node.record.grid), [this](const NodeVolume& volume) {
        return !view_volume_.isOutside(volume) && !horizon_.hides(volume) && !(hides_ && hides_(volume));
      });
}

// False, and counted, if nothing of the node can be seen.
bool Scheduler::maySee(CutNode& candidate) {
  if (view_volume_.isOutside(candidate.volume)) {
    ++statistics_.out_of_view;
    candidate.unseen = Unseen::kOutOfView;
    return false;
  }
  if (horizon_.hides(candidate.volume)) {
    ++statistics_.beyond_horizon;
    candidate.unseen = Unseen::kBeyondHorizon;
    return false;
  }
  if (facesAway(candidate.node, view_.eye)) {
    ++statistics_.facing_away;
    candidate.unseen = Unseen::kFacingAway;
    return false;
  }
  return true;
}

// Whether a terrain node that may be seen is, as far as can be told now. What must be opened anyway is not
// asked for.
void Scheduler::look(CutNode& candidate) {
  candidate.in_view = true;
  if (candidate.seamed && candidate.node.record.level > 0) return;
  candidate.waiting = candidate.distance >= farthest_;
  candidate.in_view = !candidate.waiting;
  if (candidate.in_view && hides_ && hides_(candidate.volume)) {
    ++statistics_.occluded;
    candidate.in_view = false;
    candidate.unseen = Unseen::kOccluded;
  }
}

// Replaces the waiting nodes by what is fine enough below them, and appends that to the cut.
Status Scheduler::refine(std::vector<Node>& waiting) {
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
      CutNode candidate;
      candidate.node = child;
      candidate.in_view = true;
      candidate.seamed = seam == SeamState::kTouched;
      if (terrain) {
        candidate.volume = volumeOf(child, database_.grid(child.record.grid), !candidate.seamed);
        candidate.distance = leastDistance(candidate.volume, view_.eye);
        candidate.in_view = !options_.cull || maySee(candidate);
        if (candidate.in_view) look(candidate);
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

// Looks at the waiting nodes that are near enough now.
Status Scheduler::lookFarther() {
  std::unordered_set<std::uint32_t> opened, changed;  // record numbers
  std::vector<Node> waiting;
  for (CutNode& candidate : nodes_) {
    if (!candidate.waiting || candidate.distance >= farthest_) continue;
    changed.insert(candidate.node.number);
    look(candidate);
    if (isFineEnough(candidate)) continue;
    if (candidate.in_view) ++statistics_.opened;
    opened.insert(candidate.node.number);
    waiting.push_back(candidate.node);
  }
  remove(opened, changed);
  return refine(waiting);
}

// Takes nodes out of the cut, and forgets the strips that followed from changed ones.
void Scheduler::remove(const std::unordered_set<std::uint32_t>& removed,
                       const std::unordered_set<std::uint32_t>& changed) {
  strips_.resize(nodes_.size());
  std::size_t kept = 0;
  for (std::size_t n = 0; n < nodes_.size(); ++n) {
    if (removed.contains(nodes_[n].node.number)) continue;
    Strip& strip = strips_[n];
    strip.known = strip.known && std::none_of(strip.depends.begin(), strip.depends.end(),
                                              [&](std::uint32_t other) { return changed.contains(other); });
    if (kept != n) {
      nodes_[kept] = nodes_[n];
      strips_[kept] = std::move(strip);
    }
    ++kept;
  }
  nodes_.resize(kept);
  strips_.resize(kept);
}

// The coarser node that contributes most, as an index of nodes_; kNone if there is none.
std::uint32_t Scheduler::weighStrip(const StripErrors& strips, std::uint32_t n) {
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
Status Scheduler::refineBesideStrips() {
  for (;;) {
    strips_.resize(nodes_.size());
    const CutIndex index(database_, nodes_);
    const StripErrors strips(database_, nodes_, index);
    std::unordered_set<std::uint32_t> refined;  // record numbers
    std::vector<Node> waiting;
    for (std::uint32_t n = 0; n < nodes_.size(); ++n) {
      if (!nodes_[n].in_view || strips_[n].known) continue;
      const std::uint32_t coarser = weighStrip(strips, n);
      if (coarser == CutIndex::kNone || (options_.tolerance > 0 && strips_[n].pixels <= options_.tolerance))
        continue;
      const CutNode& refining = nodes_[coarser];
      if (refining.frozen) {
        contradicted_ = true;
        must_open_.insert(refining.node.number);
      }
      if (!refined.insert(refining.node.number).second) continue;
      ++statistics_.opened;
      waiting.push_back(refining.node);
    }
    if (refined.empty() || contradicted_) return Success{};
    remove(refined, refined);
    DELTAZ_TRY(refine(waiting));
  }
}

bool Scheduler::complete() const {
  return begun_ && std::none_of(nodes_.begin(), nodes_.end(), [](const CutNode& n) { return n.waiting; });
}

double Scheduler::nearestWaiting() const {
  double nearest = std::numeric_limits<double>::infinity();
  for (const CutNode& node : nodes_) {
    if (node.waiting) nearest = std::min(nearest, node.distance);
  }
  return nearest;
}

// What the border of a node follows from: the nodes that touch it, and, since the ends of a coarser one's
// edges may follow edges that are coarser still, the coarser ones that touch those. Some more than once.
std::vector<std::uint32_t> Scheduler::bordersOf(const CutIndex& index, std::uint32_t node) const {
  std::vector<std::uint32_t> borders, touching, from = {node};
  for (std::size_t k = 0; k < from.size(); ++k) {
    const NodeRecord& record = nodes_[from[k]].node.record;
    touching.clear();
    index.appendTouching(positionOf(record), touching);
    for (const std::uint32_t other : touching) {
      // What is not drawn moves nothing.
      if (!nodes_[other].in_view && !nodes_[other].waiting) continue;
      const bool coarser = nodes_[other].node.record.level > record.level;
      if (k == 0 || coarser) borders.push_back(other);
      if (coarser && std::find(from.begin(), from.end(), other) == from.end()) from.push_back(other);
    }
  }
  return borders;
}

std::vector<std::uint32_t> Scheduler::ready() const {
  // Breadth first from what is waiting.
  std::vector<std::uint8_t> rings(nodes_.size(), kRings);
  std::vector<std::uint32_t> front, next, touching;
  for (std::uint32_t n = 0; n < nodes_.size(); ++n) {
    if (!nodes_[n].waiting) continue;
    rings[n] = 0;
    front.push_back(n);
  }
  std::optional<CutIndex> index;
  if (!front.empty()) {
    index.emplace(database_, nodes_);
    for (std::uint8_t ring = 1; ring < kRings; ++ring) {
      next.clear();
      for (const std::uint32_t n : front) {
        touching.clear();
        index->appendTouching(positionOf(nodes_[n].node.record), touching);
        for (const std::uint32_t other : touching) {
          // What is not drawn moves nothing, and needs no refining.
          if (!nodes_[other].in_view || rings[other] <= ring) continue;
          rings[other] = ring;
          next.push_back(other);
        }
      }
      std::swap(front, next);
    }
  }
  // Seams reach across grids, so what they touch comes last.
  const bool all = complete();
  std::vector<std::uint32_t> ready;
  for (std::uint32_t n = 0; n < nodes_.size(); ++n) {
    const CutNode& node = nodes_[n];
    if (!node.in_view || node.drawn || node.occluded || rings[n] < kRings) continue;
    if (all) {
      ready.push_back(n);
    } else if (!node.seamed) {
      const std::vector<std::uint32_t> borders = bordersOf(*index, n);
      if (std::none_of(borders.begin(), borders.end(), [&](std::uint32_t b) { return nodes_[b].waiting; }))
        ready.push_back(n);
    }
  }
  sortFrontToBack(ready);
  return ready;
}

void Scheduler::setDrawn(std::span<const std::uint32_t> nodes) {
  const CutIndex index(database_, nodes_);
  for (const std::uint32_t n : nodes) {
    nodes_[n].drawn = nodes_[n].frozen = true;
    for (const std::uint32_t other : bordersOf(index, n)) nodes_[other].frozen = true;
  }
}

void Scheduler::setOccluded(std::uint32_t node) {
  nodes_[node].occluded = true;
  nodes_[node].unseen = Unseen::kOccluded;
  ++statistics_.occluded;
}

void Scheduler::countTriangles(const CutNode& node, FrameStatistics::FullResolution& counts) const {
  const NodePosition position = positionOf(node.node.record);
  const GridGeometry& grid = database_.grid(position.grid);
  const std::uint64_t all = gridTriangles(grid, position, 0);
  switch (node.unseen) {
    case Unseen::kOutOfView:
      counts.out_of_view += all;
      return;
    case Unseen::kBeyondHorizon:
      counts.beyond_horizon += all;
      return;
    case Unseen::kFacingAway:
      counts.facing_away += all;
      return;
    case Unseen::kOccluded:
      counts.occluded += all;
      return;
    case Unseen::kNot:
      break;
  }
  const std::uint64_t drawn = std::min(all, gridTriangles(grid, position, position.level));
  counts.drawn += drawn;
  counts.coarser += all - drawn;
}

Schedule Scheduler::finish() {
  Schedule schedule;
  strips_.resize(nodes_.size());
  std::optional<CutIndex> index;
  std::optional<StripErrors> strips;
  bool first = true;
  for (std::uint32_t n = 0; n < nodes_.size(); ++n) {
    countTriangles(nodes_[n], schedule.full_resolution);
    if (!nodes_[n].in_view || nodes_[n].occluded) continue;
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
  for (std::uint32_t n = 0; n < nodes_.size(); ++n) {
    if (nodes_[n].in_view && !nodes_[n].occluded) schedule.front_to_back.push_back(n);
  }
  sortFrontToBack(schedule.front_to_back);
  schedule.nodes = std::move(nodes_);
  return schedule;
}

void Scheduler::sortFrontToBack(std::vector<std::uint32_t>& nodes) const {
  std::sort(nodes.begin(), nodes.end(), [this](std::uint32_t a, std::uint32_t b) {
    return std::pair(nodes_[a].distance, nodes_[a].node.number) <
           std::pair(nodes_[b].distance, nodes_[b].node.number);
  });
}

Result<Schedule> scheduleNodes(const Database& database, const SeamIndex& seams, const ViewTransform& view,
                               const ScheduleOptions& options, FrameStatistics::Nodes& statistics) {
  Scheduler scheduler(database, seams, view, options, statistics);
  DELTAZ_TRY(scheduler.advance(std::numeric_limits<double>::infinity(), {}));
  return scheduler.finish();
}

}  // namespace deltaz
