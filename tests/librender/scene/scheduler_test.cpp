#include "librender/scene/scheduler.h"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <set>

#include "librender/scene/view_volume.h"
#include "tests/librender/test_databases.h"

namespace deltaz {
namespace {

// The definition, from all nodes of a level: the largest bound of those in view.
double boundOfLevel(const Database& database, const ViewTransform& view, int level,
                    std::set<std::uint32_t>& in_view) {
  const ViewVolume volume(view);
  double largest = 0;
  in_view.clear();
  const Result<std::vector<Node>> nodes = nodesOfLevel(database, 0, level);
  EXPECT_TRUE(nodes.ok());
  for (const Node& node : nodes.value()) {
    if (node.record.isEmpty() || volume.isOutside(node.centroid, node.radius())) continue;
    in_view.insert(node.number);
    if (level > 0)
      largest =
          std::max(largest, projectedErrorBound(view, node.centroid, node.radius(), node.geometricError()));
  }
  return largest;
}

TEST(Scheduler, picks_the_coarsest_level_the_tolerance_allows) {
  const MemoryDatabase area = makeDatabase(smallArea());
  const int levels = area.database.grid(0).header().level_count;
  ASSERT_GT(levels, 2);
  std::set<int> chosen;
  for (const double above : {500.0, 20000.0, 150000.0, 1000000.0}) {
    const Camera camera =
        cameraOver(area.database, 0.5, -0.5, above, 0, above < 1000 ? -5.0 : -80.0, 640, 400);
    const ViewTransform view = makeViewTransform(camera, EllipsoidShape{});
    for (const double tolerance : {0.1, 1.0, 4.0, 1000.0}) {
      FrameStatistics::Nodes counts;
      const Result<Schedule> schedule = scheduleNodes(area.database, view, tolerance, -1, counts);
      ASSERT_TRUE(schedule.ok());
      const int level = schedule.value().level;
      chosen.insert(level);
      std::set<std::uint32_t> in_view;
      EXPECT_LE(boundOfLevel(area.database, view, level, in_view), tolerance);
      EXPECT_LE(schedule.value().projected_error, tolerance);
      // Nothing in view is missing. (A parent out of view may have spared the walk a node whose sphere is
      // not.)
      std::set<std::uint32_t> drawn;
      for (const Node& node : schedule.value().nodes) drawn.insert(node.number);
      EXPECT_TRUE(std::includes(in_view.begin(), in_view.end(), drawn.begin(), drawn.end()));
      EXPECT_EQ(counts.drawn, drawn.size());
      if (level + 1 < levels) {
        EXPECT_GT(boundOfLevel(area.database, view, level + 1, in_view), tolerance);
      }
    }
  }
  EXPECT_GT(chosen.size(), 1u);
}

TEST(Scheduler, zero_tolerance_is_full_resolution_and_order_is_that_of_records) {
  const MemoryDatabase area = makeDatabase(smallArea());
  const ViewTransform view =
      makeViewTransform(wholeAreaCamera(area.database.area(), 320, 200, 60), EllipsoidShape{});
  FrameStatistics::Nodes counts;
  const Result<Schedule> schedule = scheduleNodes(area.database, view, 0, -1, counts);
  ASSERT_TRUE(schedule.ok());
  EXPECT_EQ(schedule.value().level, 0);
  const std::vector<Node>& nodes = schedule.value().nodes;
  EXPECT_TRUE(std::is_sorted(nodes.begin(), nodes.end(),
                             [](const Node& a, const Node& b) { return a.number < b.number; }));
  EXPECT_EQ(nodes.size(), nodesOfLevel(area.database, 0, 0).value().size());
}

TEST(Scheduler, does_not_visit_what_is_out_of_view) {
  const MemoryDatabase area = makeDatabase(smallArea());
  const ViewTransform away =
      makeViewTransform(cameraOver(area.database, 0.5, -2, 100, 180, 0, 320, 200), EllipsoidShape{});
  FrameStatistics::Nodes counts;
  const Result<Schedule> schedule = scheduleNodes(area.database, away, 0, -1, counts);
  ASSERT_TRUE(schedule.ok());
  EXPECT_TRUE(schedule.value().nodes.empty());
  EXPECT_EQ(counts.drawn, 0u);
  EXPECT_LT(counts.visited, 6u);
}

// Random points in a random sphere, moved by random vectors up to the error, both seen in the picture.
TEST(ProjectedErrorBound, is_never_too_small) {
  const Camera camera{{47, -121, 3000}, 20, -10, 5, 75, 640, 400};
  const ViewTransform view = makeViewTransform(camera, EllipsoidShape{});
  EXPECT_TRUE(rc::check([&] {
    const double radius = *rc::gen::inRange(1, 3000), error = *rc::gen::inRange(1, 1000) / 4.0;
    const Vector3 centre = view.eye + view.ray(*rc::gen::inRange(-100, 740), *rc::gen::inRange(-100, 500)) *
                                          *rc::gen::inRange(10, 20000);
    const double bound = projectedErrorBound(view, centre, radius, error);
    if (!std::isfinite(bound)) return;
    const auto direction = [] {
      return normalized(Vector3{*rc::gen::inRange(-100, 101) + 0.5, *rc::gen::inRange(-100, 101) + 0.25,
                                *rc::gen::inRange(-100, 101) + 0.125});
    };
    for (int sample = 0; sample < 30; ++sample) {
      const Vector3 point = centre + direction() * (radius * (*rc::gen::inRange(0, 101) / 100.0));
      const Vector3 a = view.toView(point), b = view.toView(point + direction() * error);
      if (a.x <= 0 || std::abs(a.y / a.x) > 320 || std::abs(a.z / a.x) > 200) continue;
      RC_ASSERT(b.x > 0);
      RC_ASSERT(std::hypot(a.y / a.x - b.y / b.x, a.z / a.x - b.z / b.x) <= bound * (1 + 1e-9));
    }
  }));
}

}  // namespace
}  // namespace deltaz
