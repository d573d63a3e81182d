#include "librender/scene/scheduler.h"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <limits>
#include <map>
#include <rapidcheck.h>
#include <set>

#include "librender/objects/border_stitcher.h"
#include "librender/scene/view_volume.h"
#include "tests/librender/cut_checks.h"
#include "tests/librender/test_databases.h"

namespace deltaz {
namespace {

// What a view draws, by record number.
std::set<std::uint32_t> drawnNodes(const Schedule& schedule) {
  std::set<std::uint32_t> drawn;
  for (const CutNode& node : schedule.nodes) {
    if (node.in_view) drawn.insert(node.node.number);
  }
  return drawn;
}

// Level-0 cells the nodes of a cut span, area ends included.
double cellsOf(const Database& database, const std::vector<CutNode>& cut) {
  double cells = 0;
  for (const CutNode& node : cut) {
    const double side = database.grid(0).header().leaf_cells * std::ldexp(1.0, node.node.record.level);
    cells += side * side;
  }
  return cells;
}

TEST(Scheduler, cuts_the_area_once_and_keeps_every_node_in_view_within_the_tolerance) {
  const MemoryDatabase area = makeDatabase(smallArea());
  const int levels = area.database.grid(0).header().level_count;
  ASSERT_GT(levels, 2);
  std::vector<CutNode> whole;
  for (const Node& node : nodesOfLevel(area.database, 0, levels - 1).value()) whole.push_back({node, true});
  std::set<int> chosen;
  for (const double above : {50.0, 500.0, 20000.0, 150000.0, 1000000.0}) {
    const Camera camera =
        cameraOver(area.database, 0.5, 0.2, above, 0, above < 1000 ? -5.0 : -80.0, 640, 400);
    const ViewTransform view = makeViewTransform(camera, EllipsoidShape{});
    for (const double tolerance : {0.1, 1.0, 4.0, 1000.0}) {
      FrameStatistics::Nodes counts;
      const Result<Schedule> schedule =
          scheduleNodes(area.database, SeamIndex(area.database), view, {tolerance}, counts);
      ASSERT_TRUE(schedule.ok());
      EXPECT_LE(schedule.value().projected_error, tolerance);
      EXPECT_EQ(counts.drawn, drawnNodes(schedule.value()).size());
      for (const CutNode& node : schedule.value().nodes) {
        if (!node.in_view) continue;
        chosen.insert(node.node.record.level);
        if (node.node.record.level == 0) continue;
        EXPECT_LE(projectedHeightErrorBound(view, node.volume, node.node.geometricError()), tolerance);
        EXPECT_LE(projectedErrorBound(view, node.volume, node.node.coverageError()), tolerance);
      }
      // Nodes at area ends span more than the area, the same at every level only if the whole is a multiple.
      EXPECT_LE(cellsOf(area.database, schedule.value().nodes), cellsOf(area.database, whole));
    }
  }
  EXPECT_GT(chosen.size(), 1u);
}

TEST(Scheduler, says_of_every_full_resolution_triangle_what_became_of_it) {
  const MemoryDatabase area = makeDatabase(smallArea());
  const GridGeometry& grid = area.database.grid(0);
  const auto all =
      static_cast<std::uint64_t>(2 * (grid.columnsAt(0).size() - 1) * (grid.rowsAt(0).size() - 1));
  for (const double above : {50.0, 500.0, 20000.0, 1000000.0}) {
    for (const double tolerance : {0.0, 4.0, 1000.0}) {
      const Camera camera =
          cameraOver(area.database, 0.5, 0.2, above, 0, above < 1000 ? -5.0 : -80.0, 640, 400);
      FrameStatistics::Nodes counts;
      const Schedule schedule =
          scheduleNodes(area.database, SeamIndex(area.database), makeViewTransform(camera, EllipsoidShape{}),
                        {tolerance}, counts)
              .value();
      const FrameStatistics::FullResolution& triangles = schedule.full_resolution;
      EXPECT_EQ(triangles.sum(), all) << above << ' ' << tolerance;
      EXPECT_EQ(triangles.out_of_view > 0, counts.out_of_view > 0);
      EXPECT_EQ(triangles.beyond_horizon > 0, counts.beyond_horizon > 0);
      EXPECT_EQ(triangles.coarser > 0, schedule.coarsest_level > 0);
    }
  }
}

TEST(Scheduler, uses_coarser_nodes_farther_away) {
  SyntheticGridOptions options = smallArea();
  options.columns = options.rows = 385;
  const MemoryDatabase area = makeDatabase(options);
  const ViewTransform view =
      makeViewTransform(cameraOver(area.database, 0.5, 0.05, 30, 0, -3, 640, 400), EllipsoidShape{});
  FrameStatistics::Nodes counts;
  const Schedule schedule =
      scheduleNodes(area.database, SeamIndex(area.database), view, {4.0}, counts).value();
  EXPECT_EQ(schedule.level, 0);
  EXPECT_GT(schedule.coarsest_level, 0);
}

TEST(Scheduler, zero_tolerance_is_full_resolution_and_order_is_that_of_records) {
  const MemoryDatabase area = makeDatabase(smallArea());
  const ViewTransform view =
      makeViewTransform(wholeAreaCamera(area.database.area(), 320, 200, 60), EllipsoidShape{});
  FrameStatistics::Nodes counts;
  const Result<Schedule> schedule =
      scheduleNodes(area.database, SeamIndex(area.database), view, {0.0}, counts);
  ASSERT_TRUE(schedule.ok());
  EXPECT_EQ(schedule.value().coarsest_level, 0);
  const std::vector<CutNode>& nodes = schedule.value().nodes;
  EXPECT_TRUE(std::is_sorted(nodes.begin(), nodes.end(), [](const CutNode& a, const CutNode& b) {
    return a.node.number < b.node.number;
  }));
  EXPECT_EQ(nodes.size(), nodesOfLevel(area.database, 0, 0).value().size());
}

TEST(Scheduler, lists_all_that_is_in_view_nearest_first) {
  const MemoryDatabase area = makeDatabase(smallArea());
  for (const double above : {2.0, 3000.0}) {
    const ViewTransform view =
        makeViewTransform(cameraOver(area.database, 0.5, 0.5, above, 40, -8, 320, 200), EllipsoidShape{});
    FrameStatistics::Nodes counts;
    const Schedule schedule =
        scheduleNodes(area.database, SeamIndex(area.database), view, {1.0}, counts).value();
    std::set<std::uint32_t> listed;
    double last = 0;
    for (const std::uint32_t n : schedule.front_to_back) {
      const double distance = leastDistance(schedule.nodes[n].volume, view.eye);
      EXPECT_GE(distance, last);
      last = distance;
      listed.insert(schedule.nodes[n].node.number);
    }
    EXPECT_GT(last, 0);
    EXPECT_EQ(listed.size(), schedule.front_to_back.size());
    EXPECT_EQ(listed, drawnNodes(schedule));
  }
}

// A coarse node that reaches into the picture with a corner of its volume costs all of its triangles.
TEST(Scheduler, opens_a_node_if_nothing_that_can_be_seen_is_left_below_it) {
  const MemoryDatabase area = makeDatabase(smallArea(), 8);
  std::uint64_t saved = 0, more = 0;
  for (int heading = 0; heading < 360; heading += 15) {
    for (const double above : {30.0, 3000.0}) {
      const ViewTransform view = makeViewTransform(
          cameraOver(area.database, 0.5, 0.5, above, heading, -10, 320, 200), EllipsoidShape{});
      ScheduleOptions options{100.0};
      const auto drawn = [&] {
        FrameStatistics::Nodes counts;
        const Schedule schedule =
            scheduleNodes(area.database, SeamIndex(area.database), view, options, counts).value();
        EXPECT_LE(schedule.projected_error, options.tolerance);
        return schedule.front_to_back.size();
      };
      const std::size_t with = drawn();
      options.look_below = false;
      const std::size_t without = drawn();
      (with < without ? saved : more) += with < without ? without - with : with - without;
    }
  }
  EXPECT_GT(saved, 10 * more);
}

TEST(Scheduler, an_eye_inside_a_node_sees_it_at_full_resolution) {
  const MemoryDatabase area = makeDatabase(smallArea());
  for (const double above : {-200.0, -1.0, 0.01, 2.0}) {
    const ViewTransform view =
        makeViewTransform(cameraOver(area.database, 0.43, 0.61, above, 30, -5, 320, 200), EllipsoidShape{});
    FrameStatistics::Nodes counts;
    const Schedule schedule =
        scheduleNodes(area.database, SeamIndex(area.database), view, {1.0}, counts).value();
    for (const CutNode& node : schedule.nodes) {
      if (!node.in_view || length(node.node.centroid - view.eye) > node.node.radius()) continue;
      EXPECT_EQ(node.node.record.level, 0);
    }
  }
}

TEST(Scheduler, does_not_visit_what_is_out_of_view) {
  const MemoryDatabase area = makeDatabase(smallArea());
  const ViewTransform away =
      makeViewTransform(cameraOver(area.database, 0.5, -2, 100, 180, 0, 320, 200), EllipsoidShape{});
  FrameStatistics::Nodes counts;
  const Result<Schedule> schedule =
      scheduleNodes(area.database, SeamIndex(area.database), away, {0.0}, counts);
  ASSERT_TRUE(schedule.ok());
  EXPECT_EQ(counts.drawn, 0u);
  EXPECT_LT(counts.visited, 6u);
}

// Makes a cut step by step, hiding nothing, and hands every part of it to `draw`, which gets the cut and the
// indices of what is ready. True if it came to an end without contradiction.
template <typename Draw>
bool stepThrough(Scheduler& scheduler, double first, double step, const Draw& draw) {
  for (double farthest = 0;;) {
    if (!scheduler.advance(farthest, {}).ok()) return false;
    if (scheduler.contradicted()) return false;
    const std::vector<std::uint32_t> ready = scheduler.ready();
    draw(scheduler.cut(), ready);
    scheduler.setDrawn(ready);
    if (scheduler.complete()) return true;
    farthest = std::max({first, step * farthest, step * scheduler.nearestWaiting()});
  }
}

// The vertices and splits of nodes of a cut.
std::map<std::uint32_t, std::pair<TerrainVertices, TerrainSplits>> stitchedNodes(
    const Database& database, const ViewTransform& view, const SeamIndex& seams,
    const std::vector<CutNode>& cut, const std::vector<std::uint32_t>& nodes) {
  const CutIndex index(database, cut);
  std::vector<TerrainTile> tiles(cut.size());
  std::vector<TerrainVertices> vertices(cut.size());
  std::vector<ProcessedNode> processed(cut.size());
  for (const std::uint32_t n : nodesToProcess(database, cut, index, seams, nodes)) {
    tiles[n] = database.terrain(cut[n].node).value();
    vertices[n] = terrainVertices(tiles[n], database.grid(tiles[n].grid), view, Light{});
    processed[n] = {&tiles[n], &vertices[n]};
  }
  const BorderStitcher stitcher(database, cut, index, seams, processed);
  std::map<std::uint32_t, std::pair<TerrainVertices, TerrainSplits>> stitched;
  for (const std::uint32_t n : nodes) {
    auto& [of_node, splits] = stitched[cut[n].node.number];
    of_node = stitcher.vertices(n, splits);
    (void)stitcher.seamFaces(n, of_node);
  }
  return stitched;
}

TEST(Scheduler, says_ready_only_of_nodes_around_which_nothing_changes_any_more) {
  SyntheticGridOptions rough = smallArea();
  rough.columns = rough.rows = 257;
  int complete = 0, contradicted = 0;
  std::size_t early = 0, levels = 0;
  for (const std::uint32_t seed : {1u, 2u, 3u}) {
    rough.seed = seed;
    const MemoryDatabase memory = makeDatabase(rough, 8);
    const Database& database = memory.database;
    const SeamIndex seams(database);
    for (int n = 0; n < viewsPerArea(10); ++n) {
      const ViewTransform view = makeViewTransform(
          cameraOver(database, 0.2 + 0.05 * n, 0.1 + 0.03 * n, 100 * (1 + n), 20.0 * n, -10, 320, 200),
          EllipsoidShape{});
      FrameStatistics::Nodes counts;
      Scheduler scheduler(database, seams, view, {2.0}, counts);
      std::map<std::uint32_t, std::pair<TerrainVertices, TerrainSplits>> drawn;
      const bool ended =
          stepThrough(scheduler, 2000, 1.5, [&](const auto& cut, const std::vector<std::uint32_t>& ready) {
            if (!scheduler.complete()) early += ready.size();
            drawn.merge(stitchedNodes(database, view, seams, cut, ready));
          });
      if (!ended) {
        EXPECT_TRUE(scheduler.contradicted());
        ++contradicted;
        continue;
      }
      ++complete;
      const Schedule schedule = scheduler.finish();
      levels += schedule.coarsest_level > schedule.level ? 1 : 0;
      EXPECT_LE(schedule.projected_error, 2.0);
      EXPECT_EQ(counts.visited, counts.empty + counts.opened + counts.out_of_view + counts.beyond_horizon +
                                    counts.facing_away + counts.drawn);
      const auto final = stitchedNodes(database, view, seams, schedule.nodes, schedule.front_to_back);
      ASSERT_EQ(drawn.size(), final.size());
      for (const auto& [number, expected] : final) {
        ASSERT_TRUE(drawn.contains(number));
        const auto& [vertices, splits] = drawn.at(number);
        EXPECT_TRUE(vertices.position == expected.first.position) << number;
        EXPECT_EQ(splits.south, expected.second.south);
        EXPECT_EQ(splits.east, expected.second.east);
        EXPECT_EQ(splits.north, expected.second.north);
        EXPECT_EQ(splits.west, expected.second.west);
      }
    }
  }
  EXPECT_GT(complete, contradicted);
  EXPECT_GT(early, 100u);
  EXPECT_GT(levels, 5u);
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
