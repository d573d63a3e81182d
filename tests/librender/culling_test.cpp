// What is skipped must not be missed, and nothing may show through the ground.
#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <set>

#include "libdb/access/grid_locator.h"
#include "libdb/access/plan_shape.h"
#include "tests/librender/cut_checks.h"
#include "tests/librender/picture_comparison.h"
#include "tests/librender/scene/node_samples.h"
#include "tests/librender/test_databases.h"
#include "tests/support/synthetic_grid.h"

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

// Where all nodes are of one level no border is stitched, so what is left out must change nothing at all.
TEST(Culling, leaves_every_bit_of_a_picture_as_it_is) {
  FrameStatistics::Nodes counts;
  for (const SyntheticGridOptions& options : areasOfAllSorts()) {
    const MemoryDatabase area = makeDatabase(options, 16);
    const int levels = area.database.grid(0).header().level_count;
    std::mt19937 random(23);
    for (int n = 0; n < viewsPerArea(24); ++n) {
      RenderOptions render;
      render.camera = randomView(area.database, random, 160, 120);
      if (n % 4 == 1) {
        // From far away, low over the sea, northwards.
        render.camera.eye.latitude -= std::uniform_real_distribution<double>(0.5, 5)(random);
        render.camera.eye.height = area.database.area().lowest_height +
                                   std::pow(10.0, std::uniform_real_distribution<double>(0.3, 3.5)(random));
        render.camera.heading = render.camera.pitch = 0;
      } else if (n % 4 == 3) {
        // From below.
        render.camera.eye.height -= std::uniform_real_distribution<double>(5000, 100000)(random);
        render.camera.pitch = 70;
      }
      render.keep_triangle_ids = true;
      render.fixed_level = n % levels;
      FrameStatistics culled_statistics, whole_statistics;
      const Picture culled = draw(EngineKind::kFast, area.database, render, culled_statistics);
      render.cull = false;
      const Picture whole = draw(EngineKind::kFast, area.database, render, whole_statistics);
      ASSERT_EQ(culled.rgb, whole.rgb) << inWords(render.camera);
      ASSERT_EQ(culled.depth, whole.depth) << inWords(render.camera);
      ASSERT_EQ(culled.surface, whole.surface) << inWords(render.camera);
      ASSERT_EQ(culled.triangle, whole.triangle) << inWords(render.camera);
      EXPECT_LE(culled_statistics.nodes.drawn, whole_statistics.nodes.drawn);
      EXPECT_EQ(whole_statistics.nodes.out_of_view + whole_statistics.nodes.beyond_horizon +
                    whole_statistics.nodes.facing_away,
                0u);
      counts.out_of_view += culled_statistics.nodes.out_of_view;
      counts.beyond_horizon += culled_statistics.nodes.beyond_horizon;
      counts.facing_away += culled_statistics.nodes.facing_away;
    }
  }
  EXPECT_GT(counts.out_of_view, 100u);
  EXPECT_GT(counts.beyond_horizon, 50u);
  EXPECT_GT(counts.facing_away, 20u);
}

constexpr int kNear = 3;  // pixels: the tolerance, and as much for the silhouette's own pixels

bool groundAllAround(const Picture& picture, int j, int i) {
  for (int y = std::max(0, i - kNear); y <= std::min(picture.height - 1, i + kNear); ++y) {
    for (int x = std::max(0, j - kNear); x <= std::min(picture.width - 1, j + kNear); ++x) {
      if (picture.surface[static_cast<std::size_t>(y * picture.width + x)] != Surface::kTerrain) return false;
    }
  }
  return true;
}

// Whether a void post lies within kNear pixels of what a pixel shows. A hole that falls between the samples
// of one picture may be met by another's, as far off as the tolerance allows.
bool voidNear(const RawGrid& grid, const GridGeometry& geometry, const ViewTransform& view, int j, int i,
              double depth) {
  const auto place = GridLocator(geometry).locate(view.eye + view.ray(j, i) * depth);
  if (!place) return false;
  const double reach = kNear * depth / view.pixels;  // metres
  const CellSize cell = largestCell(geometry, geometry.columnsAt(0), geometry.rowsAt(0));
  const std::int64_t across = static_cast<std::int64_t>(reach / cell.width) + 2,
                     along = static_cast<std::int64_t>(reach / cell.height) + 2;
  const GridHeader& header = grid.header;
  const std::int64_t column = place->column - header.x_axis.first, row = place->row - header.y_axis.first;
  for (std::int64_t y = std::max<std::int64_t>(0, row - along);
       y <= std::min(header.y_axis.count - 1, row + along + 1); ++y) {
    for (std::int64_t x = std::max<std::int64_t>(0, column - across);
         x <= std::min(header.x_axis.count - 1, column + across + 1); ++x) {
      if (!grid.isValid(x, y)) return true;
    }
  }
  return false;
}

// Pixels that show sea or sky although all of the reference around them is ground, and no void is near.
int seenThrough(const Picture& fast, const Picture& reference, const RawGrid& grid,
                const GridGeometry& geometry, const ViewTransform& view) {
  int count = 0;
  for (int i = 0; i < fast.height; ++i) {
    for (int j = 0; j < fast.width; ++j) {
      const std::size_t pixel = static_cast<std::size_t>(i * fast.width + j);
      if (fast.surface[pixel] == Surface::kTerrain || !groundAllAround(reference, j, i)) continue;
      if (!voidNear(grid, geometry, view, j, i, static_cast<double>(reference.depth[pixel]))) ++count;
    }
  }
  return count;
}

TEST(LevelsOfDetail, show_no_sea_or_sky_through_the_ground) {
  int coarse = 0;
  for (const SyntheticGridOptions& options : areas()) {
    const RawGrid grid = syntheticGrid(options);
    const MemoryDatabase area = makeDatabaseOf(grid, 8);
    std::mt19937 random(5);
    for (int n = 0; n < viewsPerArea(12); ++n) {
      RenderOptions render;
      render.camera = randomView(area.database, random, 240, 180);
      FrameStatistics statistics, reference_statistics;
      const Picture fast = draw(EngineKind::kFast, area.database, render, statistics);
      const Picture reference = draw(EngineKind::kReference, area.database, render, reference_statistics);
      coarse += statistics.coarsest_level > 0 ? 1 : 0;
      EXPECT_EQ(seenThrough(fast, reference, grid, area.database.grid(0),
                            makeViewTransform(render.camera, EllipsoidShape{})),
                0)
          << inWords(render.camera);
    }
  }
  EXPECT_GT(coarse, 3);
}

}  // namespace
}  // namespace deltaz
