// Cuts of many views have no cracks and keep the LOD contract.
//
// DELTAZ_VIEWS sets the number of views an area (the soak run has 2,000; by default few enough for every
// day).
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <gtest/gtest.h>
#include <limits>
#include <tbb/parallel_for.h>

#include "tests/librender/cut_checks.h"
#include "tests/librender/test_databases.h"

namespace deltaz {
namespace {

struct Outcome {
  int views = 0;
  std::uint64_t faces = 0;
  int largest_level_difference = 0;
  double worst_pixels = 0, worst_strip_pixels = 0;
  double worst_share = 0;   // of a view's tolerance
  std::uint64_t posts = 0;  // measured under faces that are not of full resolution
  std::string crack;
};

int levelDifference(const Database& database, const std::vector<CutNode>& cut) {
  const CutIndex index(database, cut);
  int largest = 0;
  for (const CutNode& node : cut) {
    for (const Side side : kSides) {
      const std::uint32_t across = index.acrossWhole(positionOf(node.node.record), side);
      if (across != CutIndex::kNone)
        largest = std::max(largest, cut[across].node.record.level - node.node.record.level);
    }
  }
  return largest;
}

// View number `n`: the same whatever the number of views and threads.
Outcome tryView(const Database& database, int n, const FullResolution* full, const ScheduleOptions& options) {
  Outcome outcome;
  outcome.views = 1;
  std::mt19937 random(static_cast<std::uint32_t>(n) * 7919u + 7u);
  const Camera camera = randomView(database, random, 256, 192);
  const ViewTransform view = makeViewTransform(camera, database.area().grids.front().ellipsoid);
  FrameStatistics::Nodes counts;
  const Result<Schedule> schedule = scheduleNodes(database, SeamIndex(database), view, options, counts);
  if (!schedule.ok()) throw std::runtime_error(schedule.error().message());
  EXPECT_LE(schedule.value().projected_error, options.tolerance);
  const CutMesh mesh = meshOfCut(database, schedule.value(), view);
  outcome.largest_level_difference = levelDifference(database, mesh.cut);
  for (const MeshNode& node : mesh.nodes) outcome.faces += node.faces.size();
  outcome.crack = findCrack(database, mesh);
  const CutMesh drawn = meshOfCut(database, schedule.value(), view, MeshPart::kInView);
  if (outcome.crack.empty()) outcome.crack = findCrack(database, drawn);
  if (full != nullptr) {
    const ContractFinding finding = measureContract(database, drawn, *full, view);
    outcome.worst_pixels = finding.worst_pixels;
    outcome.worst_strip_pixels = finding.worst_strip_pixels;
    outcome.worst_share = finding.worst_pixels / options.tolerance;
    outcome.posts = finding.posts;
  }
  if (!outcome.crack.empty() || outcome.worst_pixels > options.tolerance) {
    std::printf("view %d: %s: %.3f px %s\n", n, inWords(camera).c_str(), outcome.worst_pixels,
                outcome.crack.c_str());
  }
  return outcome;
}

Outcome tryViews(const Database& database, int views) {
  const FullResolution full(database, 0);
  std::vector<Outcome> outcomes(static_cast<std::size_t>(views));
  tbb::parallel_for(0, views, [&](int n) {
    // At a pixel most of what is near is drawn at full resolution, so every other view allows eight.
    ScheduleOptions options;
    options.tolerance = n % 2 == 0 ? 1 : 8;
    outcomes[static_cast<std::size_t>(n)] = tryView(database, n, &full, options);
  });
  Outcome all;
  for (const Outcome& one : outcomes) {
    all.views += one.views;
    all.faces += one.faces;
    all.largest_level_difference = std::max(all.largest_level_difference, one.largest_level_difference);
    all.worst_pixels = std::max(all.worst_pixels, one.worst_pixels);
    all.worst_strip_pixels = std::max(all.worst_strip_pixels, one.worst_strip_pixels);
    all.worst_share = std::max(all.worst_share, one.worst_share);
    all.posts += one.posts;
    if (all.crack.empty()) all.crack = one.crack;
  }
  return all;
}

void print(const char* area, const Outcome& outcome) {
  std::printf(
      "%s: %d views, %.0f faces a view, level difference up to %d, worst %.3f px, strips %.3f px, %.3f of "
      "the "
      "tolerance, %llu posts\n",
      area, outcome.views, static_cast<double>(outcome.faces) / outcome.views,
      outcome.largest_level_difference, outcome.worst_pixels, outcome.worst_strip_pixels, outcome.worst_share,
      static_cast<unsigned long long>(outcome.posts));
}

struct SyntheticCase {
  const char* name;
  SyntheticGridOptions options;
  int leaf_cells;
};

std::vector<SyntheticCase> syntheticCases() {
  SyntheticGridOptions rough = smallArea();
  rough.columns = rough.rows = 193;
  SyntheticGridOptions voids = rough;
  voids.voids = VoidPattern::kHole;
  SyntheticGridOptions scattered = rough;
  scattered.voids = VoidPattern::kScattered;
  SyntheticGridOptions odd = rough;  // ends between the multiples of every level
  odd.south = 59.9125;
  odd.columns = 203;
  odd.rows = 151;
  SyntheticGridOptions pole = rough;
  pole.south = 89.0;
  pole.spacing_latitude = {30, 1};
  pole.spacing_longitude = {300, 1};
  pole.rows = 121;
  SyntheticGridOptions flat = rough;  // zero errors beside rough ones: large level differences
  flat.voids = VoidPattern::kWestHalf;
  flat.lowest = 0;
  flat.highest = 3;
  return {{"rough", rough, 16}, {"hole", voids, 8}, {"scattered voids", scattered, 8},
          {"odd ends", odd, 8}, {"pole", pole, 16}, {"flat", flat, 8}};
}

TEST(CrackFree, no_view_of_a_synthetic_area_has_a_crack) {
  double worst = 0;
  std::uint64_t posts = 0;
  for (const SyntheticCase& area : syntheticCases()) {
    const MemoryDatabase memory = makeDatabase(area.options, area.leaf_cells);
    const Outcome outcome = tryViews(memory.database, viewsPerArea(20));
    print(area.name, outcome);
    EXPECT_EQ(outcome.crack, "") << area.name;
    EXPECT_LE(outcome.worst_share, 1) << area.name;
    worst = std::max(worst, outcome.worst_share);
    posts += outcome.posts;
  }
  // The contract was put to the test: many posts, and errors that come near.
  EXPECT_GT(posts, 100000u);
  EXPECT_GT(worst, 0.25);
}

// What is said to be drawn before it is ready makes a scheduler contradict itself, which it notices and
// mends.
TEST(CrackFree, a_strip_that_reaches_what_is_drawn_is_noticed) {
  const MemoryDatabase memory = makeDatabaseOf(countryOfTwoErrors(24), 8);
  const Camera camera{{45.0, -121.947, 3000}, 0, -1.6, 0, 3, 384, 192};
  const ViewTransform view = makeViewTransform(camera, EllipsoidShape{});
  const SeamIndex seams(memory.database);
  constexpr double kFar = std::numeric_limits<double>::infinity();
  int noticed = 0;
  for (double farthest = 180000; farthest < 240000; farthest += 500) {
    FrameStatistics::Nodes counts;
    Scheduler scheduler(memory.database, seams, view, {}, counts);
    ASSERT_TRUE(scheduler.advance(farthest, {}).ok());
    std::vector<std::uint32_t> all(scheduler.cut().size());
    for (std::uint32_t k = 0; k < all.size(); ++k) all[k] = k;
    scheduler.setDrawn(all);
    ASSERT_TRUE(scheduler.advance(kFar, {}).ok());
    if (!scheduler.contradicted()) continue;
    ++noticed;
    scheduler.restart();
    ASSERT_TRUE(scheduler.advance(kFar, {}).ok());
    EXPECT_FALSE(scheduler.contradicted());
    EXPECT_LE(scheduler.finish().projected_error, 1);
    EXPECT_EQ(counts.visited, counts.empty + counts.opened + counts.out_of_view + counts.beyond_horizon +
                                  counts.facing_away + counts.drawn);
  }
  EXPECT_GT(noticed, 0);
}

TEST(CrackFree, strips_break_the_contract_unless_they_are_tested) {
  const MemoryDatabase memory = makeDatabaseOf(countryOfTwoErrors(24), 8);
  // From the south, 200 km away, where a pixel is 27 m.
  Camera camera{{45.0, -121.947, 3000}, 0, -1.6, 0, 3, 384, 192};
  const ViewTransform view = makeViewTransform(camera, EllipsoidShape{});
  const FullResolution full(memory.database, 0);
  std::array<ContractFinding, 2> findings;
  for (const bool tested : {false, true}) {
    ScheduleOptions options;
    options.test_strips = tested;
    FrameStatistics::Nodes counts;
    const Schedule schedule =
        scheduleNodes(memory.database, SeamIndex(memory.database), view, options, counts).value();
    const CutMesh mesh = meshOfCut(memory.database, schedule, view);
    EXPECT_EQ(findCrack(memory.database, mesh), "");
    findings[tested ? 1 : 0] = measureContract(memory.database, mesh, full, view);
  }
  std::printf("strips untested: %.3f px, tested: %.3f px, over %llu posts\n", findings[0].worst_strip_pixels,
              findings[1].worst_pixels, static_cast<unsigned long long>(findings[1].posts));
  EXPECT_GT(findings[0].worst_strip_pixels, 1);
  EXPECT_LE(findings[1].worst_pixels, 1);
  EXPECT_GT(findings[1].posts, 1000u);
}

// What the mesh checker must find.
TEST(CrackFree, a_vertex_out_of_place_and_a_missing_face_are_found) {
  const MemoryDatabase memory = makeDatabase(smallArea(), 16);
  const Camera camera = cameraOver(memory.database, 0.2, 0.2, 400, 45, -10, 256, 192);
  const ViewTransform view = makeViewTransform(camera, EllipsoidShape{});
  FrameStatistics::Nodes counts;
  const Schedule schedule =
      scheduleNodes(memory.database, SeamIndex(memory.database), view, {}, counts).value();
  const CutMesh mesh = meshOfCut(memory.database, schedule, view);
  ASSERT_EQ(findCrack(memory.database, mesh), "");
  CutMesh moved = mesh;
  moved.nodes.front().vertices.position.front().z += 1e-9;
  EXPECT_NE(findCrack(memory.database, moved), "");
  CutMesh holed = mesh;
  holed.nodes.back().faces.pop_back();
  EXPECT_NE(findCrack(memory.database, holed), "");
  CutMesh doubled = mesh;
  doubled.nodes.back().faces.push_back(doubled.nodes.back().faces.front());
  EXPECT_NE(findCrack(memory.database, doubled), "");
}

// Unstitched, the same cuts do crack: the checker is not blind to what it is there for.
TEST(CrackFree, levels_side_by_side_without_stitching_are_found) {
  const MemoryDatabase memory = makeDatabase(smallArea(), 16);
  const Camera camera = cameraOver(memory.database, 0.2, 0.2, 400, 45, -10, 256, 192);
  const ViewTransform view = makeViewTransform(camera, EllipsoidShape{});
  FrameStatistics::Nodes counts;
  const Schedule schedule =
      scheduleNodes(memory.database, SeamIndex(memory.database), view, {}, counts).value();
  ASSERT_GT(levelDifference(memory.database, schedule.nodes), 0);
  CutMesh mesh = meshOfCut(memory.database, schedule, view);
  for (MeshNode& node : mesh.nodes) {
    const TerrainTile& tile = *mesh.tiles[node.cut_node];
    node.vertices.position = terrainPositions(tile, memory.database.grid(0), view);
    node.posts.resize(node.vertices.position.size());
    std::vector<Vector3> plan;
    for (const auto& post : node.posts)
      plan.push_back({1, static_cast<double>(post[0] - node.posts[0][0]),
                      -static_cast<double>(post[1] - node.posts[0][1])});
    node.faces.clear();
    for (const TerrainFace& face : terrainFaces(tile, plan).front) node.faces.push_back(face.vertex);
  }
  EXPECT_NE(findCrack(memory.database, mesh), "");
}

TEST(CrackFree, no_view_of_a_real_area_has_a_crack) {
  const char* const folder = std::getenv("DELTAZ_TEST_DATA");
  std::vector<std::string> files = {std::string(DELTAZ_SAMPLES) + "/mt_rainier.tif"};
  if (folder != nullptr) {
    for (const char* const name : {"mt_everest_90m.tif", "SainteHelens.dem"})
      files.push_back(std::string(folder) + "/dem/" + name);
  }
  for (const std::string& file : files) {
    const std::optional<MemoryDatabase> area = databaseOfFile(file);
    if (!area) continue;
    const Outcome outcome = tryViews(area->database, viewsPerArea(2));
    print(file.c_str(), outcome);
    EXPECT_EQ(outcome.crack, "") << file;
    EXPECT_LE(outcome.worst_share, 1) << file;
  }
}

}  // namespace
}  // namespace deltaz
