#include "librender/scene/scheduler.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "librender/scene/view_volume.h"

namespace deltaz {
namespace {

// Walks the tree, keeping the terrain nodes in view.
class Walk {
 public:
  Walk(const Database& database, const ViewTransform& view, FrameStatistics::Nodes& statistics)
      : database_(database), volume_(view), statistics_(statistics) {}

  // Appends the children of `parent` that are in view; clusters are replaced by their own children.
  Status expand(const Node& parent, std::vector<Node>& nodes) {
    DELTAZ_TRY_ASSIGN(const std::vector<Node> children, database_.children(parent));
    for (const Node& child : children) {
      ++statistics_.visited;
      if (child.record.isEmpty()) continue;
      if (volume_.isOutside(child.centroid, child.radius())) {
        ++statistics_.out_of_view;
      } else if (child.record.type == NodeType::kTerrain) {
        nodes.push_back(child);
      } else if (child.record.type == NodeType::kCluster) {
        DELTAZ_TRY(expand(child, nodes));
      }
    }
    return Success{};
  }

 private:
  const Database& database_;
  ViewVolume volume_;
  FrameStatistics::Nodes& statistics_;
};

int coarsestLevel(const std::vector<Node>& nodes) {
  int level = 0;
  for (const Node& node : nodes) level = std::max<int>(level, node.record.level);
  return level;
}

double largestProjectedError(const ViewTransform& view, const std::vector<Node>& nodes) {
  double largest = 0;
  for (const Node& node : nodes) {
    // A leaf is what the error is measured against.
    if (node.record.level == 0) continue;
    largest =
        std::max(largest, projectedErrorBound(view, node.centroid, node.radius(), node.geometricError()));
  }
  return largest;
}

}  // namespace

double projectedErrorBound(const ViewTransform& view, const Vector3& centre, double radius, double error) {
  if (error == 0) return 0;
  if (!(error < std::numeric_limits<double>::infinity())) return error;
  const Vector3 offset = centre - view.eye;
  const double tangent_squared = largestTangentSquared(view);
  // Two lower bounds of the depth of a point of the sphere that is in the picture: the sphere's nearest
  // depth, and, because |p| = U sqrt(1 + tangent^2), its nearest distance divided by the picture's largest
  // slant.
  const double nearest_depth = dot(view.forward, offset) - radius;
  const double nearest_slant = (length(offset) - radius) / std::sqrt(1 + tangent_squared);
  const double depth = std::max(nearest_depth, nearest_slant) - error;
  if (!(depth > 0)) return std::numeric_limits<double>::infinity();
  return view.pixels * error * std::sqrt(1 + tangent_squared) / depth;
}

Result<Schedule> scheduleNodes(const Database& database, const ViewTransform& view, double tolerance,
                               int fixed_level, FrameStatistics::Nodes& statistics) {
  Walk walk(database, view, statistics);
  DELTAZ_TRY_ASSIGN(const Node root, database.root());
  std::vector<Node> nodes;
  DELTAZ_TRY(walk.expand(root, nodes));

  Schedule schedule;
  for (schedule.level = coarsestLevel(nodes);; --schedule.level) {
    schedule.projected_error = largestProjectedError(view, nodes);
    const bool enough =
        fixed_level >= 0 ? schedule.level <= fixed_level : schedule.projected_error <= tolerance;
    if (schedule.level == 0 || (enough && (fixed_level >= 0 || tolerance > 0))) break;
    // Nodes of grids that have no level this coarse stay until their own turn.
    std::vector<Node> finer;
    for (const Node& node : nodes) {
      if (node.record.level < schedule.level) {
        finer.push_back(node);
      } else {
        DELTAZ_TRY(walk.expand(node, finer));
      }
    }
    nodes = std::move(finer);
  }
  std::sort(nodes.begin(), nodes.end(), [](const Node& a, const Node& b) { return a.number < b.number; });
  statistics.drawn = nodes.size();
  schedule.nodes = std::move(nodes);
  return schedule;
}

}  // namespace deltaz
