#include "tests/librender/drawn_ground.h"

#include <algorithm>
#include <gtest/gtest.h>

#include "tests/librender/test_databases.h"

namespace deltaz {
namespace {

std::uint64_t pixelsFromBelow(const Ground& ground, const ViewTransform& view) {
  const std::vector<std::uint8_t> flags = seenFromBelow(ground, view);
  return static_cast<std::uint64_t>(std::count(flags.begin(), flags.end(), 1));
}

// Some hundred metres over rough country, northwards.
ViewTransform viewOver(const Database& database) {
  return makeViewTransform(cameraOver(database, 0.5, 0.1, 300, 0, -8, 320, 200), EllipsoidShape{});
}

TEST(DrawnGround, has_no_cracks_at_full_resolution_nor_in_a_cut_by_error) {
  const MemoryDatabase area = makeDatabase(smallArea());
  const ViewTransform view = viewOver(area.database);
  const Ground full = groundByRange(area.database, view, {1e9});
  EXPECT_EQ(pixelsFromBelow(full, view), 0u);
  EXPECT_EQ(unmatchedEdges(full.faces), 0u);
  std::size_t faces = 0;
  for (const double tolerance : {20.0, 5.0, 0.0}) {
    FrameStatistics::Nodes counts;
    const Schedule schedule =
        scheduleNodes(area.database, SeamIndex(area.database), view, {tolerance}, counts).value();
    const Ground ground = groundOfCut(area.database, meshOfCut(area.database, schedule, view), view);
    EXPECT_GT(ground.faces.size(), faces);
    faces = ground.faces.size();
    EXPECT_EQ(pixelsFromBelow(ground, view), 0u) << tolerance;
    EXPECT_EQ(unmatchedEdges(ground.faces), 0u) << tolerance;
  }
}

TEST(DrawnGround, has_cracks_between_the_levels_of_the_report_and_fewer_with_double_processing) {
  const MemoryDatabase area = makeDatabase(smallArea());
  const ViewTransform view = viewOver(area.database);
  const auto cracks = [&](double overlap) {
    const Ground ground = groundByRange(area.database, view, {4000, 0.495, overlap});
    EXPECT_GT(unmatchedEdges(ground.faces), 0u);
    return pixelsFromBelow(ground, view);
  };
  const std::uint64_t without = cracks(0), with = cracks(0.25);
  EXPECT_GT(without, 0u);
  EXPECT_LT(with, without);
}

TEST(DrawnGround, seen_through_a_crack_lies_behind_the_ground_there) {
  const MemoryDatabase area = makeDatabase(smallArea());
  RenderOptions options;
  options.camera = cameraOver(area.database, 0.5, 0.1, 300, 0, -8, 320, 200);
  options.tolerance = 0;
  const Picture full = draw(EngineKind::kFast, area.database, options);
  options.lod = LodScheme::kReport;
  options.report_lod = {4000, 0.495, 0};
  const Picture cracked = draw(EngineKind::kFast, area.database, options);
  const ViewTransform view = viewOver(area.database);
  const std::vector<std::uint8_t> flags =
      seenFromBelow(groundByRange(area.database, view, options.report_lod), view);
  int cracks = 0, behind = 0;
  for (std::size_t pixel = 0; pixel < flags.size(); ++pixel) {
    if (flags[pixel] == 0) continue;
    ++cracks;
    if (cracked.depth[pixel] > full.depth[pixel] * 1.01F) ++behind;
  }
  EXPECT_GT(cracks, 0);
  // A vertex is snapped for the picture, so that now and then a crack narrower than that closes.
  EXPECT_GE(behind, cracks * 9 / 10) << cracks;
}

TEST(DrawnGround, is_displaced_as_far_as_the_levels_contract_says_of_the_same_faces) {
  const MemoryDatabase area = makeDatabase(smallArea());
  const ViewTransform view = viewOver(area.database);
  const FullResolution full(area.database, 0);
  // A cut of one level has no borders that move.
  FrameStatistics::Nodes counts;
  const Schedule schedule =
      scheduleNodes(area.database, SeamIndex(area.database), view, {1, 2}, counts).value();
  const CutMesh mesh = meshOfCut(area.database, schedule, view);
  const double expected = measureContract(area.database, mesh, full, view).worst_pixels;
  EXPECT_GT(expected, 0.1);
  EXPECT_NEAR(largestDisplacement(area.database, groundOfCut(area.database, mesh, view).faces, full, view),
              expected, 1e-9 * expected);
  // The fifth level of the report is that level, where objects are as large as they can be.
  EXPECT_NEAR(largestDisplacement(area.database, groundByRange(area.database, view, {1}).faces, full, view),
              expected, 1e-9 * expected);
}

TEST(DrawnGround, has_edges_without_partner_at_a_post_of_one_side_alone) {
  const auto face = [](std::array<std::array<std::int64_t, 2>, 3> posts) {
    GroundFace ground;
    ground.post = posts;
    return ground;
  };
  // Two squares of 8 x 8 cells; the eastern one keeps the post between.
  EXPECT_EQ(unmatchedEdges({face({{{0, 0}, {8, 0}, {8, 8}}}), face({{{0, 0}, {8, 8}, {0, 8}}}),
                            face({{{8, 0}, {16, 0}, {8, 4}}}), face({{{16, 0}, {16, 8}, {8, 4}}}),
                            face({{{16, 8}, {8, 8}, {8, 4}}})}),
            3u);
}

TEST(DrawnGround, shows_its_floor_and_undersides_through_cracks) {
  ViewTransform view;
  view.pixels = 100;
  view.width = view.height = 64;
  view.centre_j = view.centre_i = 31.5;
  // A strip of level ground from u0 to u1, `below` the eye.
  const auto strip = [&](double u0, double u1, double below0, double below1) {
    const auto at = [&](double u, double right, double below) {
      return Vector3{u, right * view.pixels, below * view.pixels};
    };
    return std::array{std::array{at(u0, -500, below0), at(u0, 500, below0), at(u1, 500, below1)},
                      std::array{at(u0, -500, below0), at(u1, 500, below1), at(u1, -500, below1)}};
  };
  Ground ground;
  const auto add = [&](const auto& faces) {
    for (const auto& positions : faces) {
      ground.faces.emplace_back().position = positions;
    }
  };
  // A step half a metre up, ten metres away, without a riser: it is seen through in rows 37 to 41.
  add(strip(2, 10, 1, 1));
  add(strip(10, 30, 0.5, 0.5));
  EXPECT_EQ(pixelsFromBelow(ground, view), 0u);
  for (const auto& positions : strip(2, 200, 9, 9)) ground.floor.push_back(positions);
  EXPECT_EQ(pixelsFromBelow(ground, view), 5u * 64u);
  EXPECT_EQ(seenFromBelow(ground, view)[40 * 64], 1);
  EXPECT_EQ(seenFromBelow(ground, view)[36 * 64], 0);
  EXPECT_EQ(seenFromBelow(ground, view)[42 * 64], 0);
  // Where the ground behind falls away its underside shows.
  ground.floor.clear();
  add(strip(30, 40, 0.5, 6));
  EXPECT_EQ(pixelsFromBelow(ground, view), 5u * 64u);
}

}  // namespace
}  // namespace deltaz
