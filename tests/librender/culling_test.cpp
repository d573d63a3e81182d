// What is skipped must not be missed, and nothing may show through the ground.
#include <cstdio>
#include <cstdlib>
#include <gtest/gtest.h>
#include <set>

#include "tests/librender/cut_checks.h"
#include "tests/librender/picture_comparison.h"
#include "tests/librender/test_databases.h"

namespace deltaz {
namespace {

std::vector<SyntheticGridOptions> areas() {
  std::vector<SyntheticGridOptions> result(4, smallArea());
  result[1].voids = VoidPattern::kHole;
  result[2].voids = VoidPattern::kScattered;
  result[3].south = 89.5;  // up to the pole
  result[3].spacing_latitude = {15, 1};
  result[3].spacing_longitude = {600, 1};
  return result;
}

TEST(Culling, removes_no_node_and_no_face_that_the_reference_shows) {
  for (const SyntheticGridOptions& options : areas()) {
    const MemoryDatabase area = makeDatabase(options, 16);
    std::mt19937 random(11);
    std::uint64_t out_of_view = 0, back_facing = 0, shown = 0;
    for (int n = 0; n < viewsPerArea(12); ++n) {
      RenderOptions render;
      render.camera = randomView(area.database, random, 160, 120);
      render.tolerance = 0;
      render.keep_triangle_ids = true;
      FrameStatistics fast_statistics, reference_statistics;
      const Picture reference = draw(EngineKind::kReference, area.database, render, reference_statistics);
      const Picture fast = draw(EngineKind::kFast, area.database, render, fast_statistics);
      out_of_view += fast_statistics.nodes.out_of_view;
      back_facing += fast_statistics.triangles.back_facing;

      const ViewTransform view = makeViewTransform(render.camera, EllipsoidShape{});
      FrameStatistics::Nodes counts;
      const Schedule schedule =
          scheduleNodes(area.database, SeamIndex(area.database), view, {0.0}, counts).value();
      std::set<std::uint32_t> drawn;
      for (const CutNode& node : schedule.nodes) {
        if (node.in_view) drawn.insert(node.node.number);
      }
      for (std::size_t pixel = 0; pixel < reference.surface.size(); ++pixel) {
        if (reference.surface[pixel] != Surface::kTerrain) continue;
        ++shown;
        ASSERT_TRUE(drawn.contains(static_cast<std::uint32_t>(reference.triangle[pixel] >> 32)))
            << inWords(render.camera);
      }
      const PictureDifference difference = comparePictures(area.database, render.camera, fast, reference);
      // Where the two disagree about coverage the sample lies on an edge, but for the snapping of vertices.
      EXPECT_LE(difference.farthest_from_edge, 1.0 / 256)
          << "latitude " << options.south << ", voids " << static_cast<int>(options.voids) << ", "
          << inWords(render.camera);
    }
    EXPECT_GT(out_of_view, 0u);
    EXPECT_GT(back_facing, 0u);
    EXPECT_GT(shown, 10000u);
  }
}

// Pixels that show sea or sky although all of the reference around them is ground.
int seenThrough(const Picture& fast, const Picture& reference) {
  constexpr int kNear = 3;  // the tolerance, and as much for the silhouette's own pixels
  int count = 0;
  for (int i = 0; i < fast.height; ++i) {
    for (int j = 0; j < fast.width; ++j) {
      if (fast.surface[static_cast<std::size_t>(i * fast.width + j)] == Surface::kTerrain) continue;
      bool ground = true;
      for (int di = -kNear; di <= kNear && ground; ++di) {
        for (int dj = -kNear; dj <= kNear && ground; ++dj) {
          const int y = i + di, x = j + dj;
          if (y < 0 || x < 0 || y >= fast.height || x >= fast.width) continue;
          ground = reference.surface[static_cast<std::size_t>(y * fast.width + x)] == Surface::kTerrain;
        }
      }
      count += ground ? 1 : 0;
    }
  }
  return count;
}

TEST(LevelsOfDetail, show_no_sea_or_sky_through_the_ground) {
  int coarse = 0;
  for (const SyntheticGridOptions& options : areas()) {
    const MemoryDatabase area = makeDatabase(options, 8);
    std::mt19937 random(5);
    for (int n = 0; n < viewsPerArea(12); ++n) {
      RenderOptions render;
      render.camera = randomView(area.database, random, 240, 180);
      FrameStatistics statistics, reference_statistics;
      const Picture fast = draw(EngineKind::kFast, area.database, render, statistics);
      const Picture reference = draw(EngineKind::kReference, area.database, render, reference_statistics);
      coarse += statistics.coarsest_level > 0 ? 1 : 0;
      EXPECT_EQ(seenThrough(fast, reference), 0) << inWords(render.camera);
    }
  }
  EXPECT_GT(coarse, 3);
}

}  // namespace
}  // namespace deltaz
