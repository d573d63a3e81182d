// What nearer ground hides is not read, and nothing of the picture may tell.
#include "librender/occlusion.h"

#include <cmath>
#include <gtest/gtest.h>
#include <random>
#include <tbb/task_arena.h>

#include "librender/scene/conservation.h"
#include "tests/librender/cut_checks.h"
#include "tests/librender/test_databases.h"
#include "tests/support/every_simd_target.h"
#include "tests/support/synthetic_grid.h"

namespace deltaz {
namespace {

// Close to the ground, level or downwards.
Camera lowView(const Database& database, std::mt19937& random) {
  const auto fraction = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  // One after the other: compilers choose the order of arguments themselves.
  const double pitch = fraction(-40, 5), heading = fraction(0, 360);
  const double above = std::pow(10.0, fraction(0.3, 3.3));
  const double y = fraction(0.1, 0.9), x = fraction(0.1, 0.9);
  return cameraOver(database, x, y, above, heading, pitch, 160, 120);
}

void expectSamePicture(const Picture& a, const Picture& b, const Camera& camera) {
  ASSERT_EQ(a.rgb, b.rgb) << inWords(camera);
  ASSERT_EQ(a.depth, b.depth) << inWords(camera);
  ASSERT_EQ(a.surface, b.surface) << inWords(camera);
  ASSERT_EQ(a.triangle, b.triangle) << inWords(camera);
}

std::vector<MemoryDatabase> roughAreas() {
  std::vector<MemoryDatabase> areas;
  SyntheticGridOptions options = smallArea();
  areas.push_back(makeDatabase(options, 8));
  options.voids = VoidPattern::kScattered;
  areas.push_back(makeDatabase(options, 8));
  options.voids = VoidPattern::kHole;
  areas.push_back(makeDatabase(options, 16));
  options = smallArea();
  options.spacing_latitude = options.spacing_longitude = {1, 3};
  options.highest = 700;
  areas.push_back(makeDatabase(options, 8));
  if (auto rainier = databaseOfFile(std::string(DELTAZ_SAMPLES) + "/mt_rainier.tif"))
    areas.push_back(std::move(*rainier));
  return areas;
}

// A wall across the view at U = 100, as wide as `reach` pixels to either side of the middle.
const Tiler& wallDrawn(Tiler& tiler, TileBins& bins, PretiledNode& node, const ViewTransform& view,
                       double reach) {
  TerrainVertices vertices;
  for (const double down : {-1e3, 1e3}) {
    for (const double right : {-reach, reach}) vertices.position.push_back({100, right * 100, down * 100});
  }
  vertices.light.resize(4);
  vertices.appended_texture.resize(4);
  std::vector<TerrainFace> faces = {{{0, 1, 3}, 0}, {{0, 3, 2}, 1}};
  for (TerrainFace& face : faces) {
    const auto& p = vertices.position;
    if (isBackFacing(p[face.vertex[0]], p[face.vertex[1]], p[face.vertex[2]]))
      std::swap(face.vertex[1], face.vertex[2]);
  }
  node = PretiledNode::ofTerrain(0, 1, std::move(vertices), std::move(faces));
  bins.reset(view.width, view.height, 1);
  bins.writer(0).begin(0);
  Pretiler(view).process(node, 0, bins.writer(0));
  bins.finish();
  tiler.begin(view.width, view.height);
  tiler.draw(bins);
  return tiler;
}

TEST(Occlusion, hides_what_lies_behind_what_is_drawn_and_nothing_else) {
  Camera camera;
  camera.width = 320;
  camera.height = 200;
  const ViewTransform view = makeViewTransform(camera, EllipsoidShape{});
  const auto at = [&](double u, double pixels_right) {
    return view.eye + view.ray(view.centre_j + pixels_right, view.centre_i) * u;
  };
  Tiler tiler;
  TileBins bins;
  PretiledNode node;
  constexpr double kTolerance = 2;
  tbb::task_arena(1).execute([&] {
    {
      const Occlusion occlusion(wallDrawn(tiler, bins, node, view, 1e3), view, kTolerance);
      EXPECT_TRUE(occlusion.hides(at(102, 0), 1.9));
      EXPECT_FALSE(occlusion.hides(at(102, 0), 2));  // it may touch the wall
      EXPECT_FALSE(occlusion.hides(at(90, 0), 1));
      EXPECT_FALSE(occlusion.hides(at(102, 0), 200));  // it reaches behind the eye
      EXPECT_TRUE(occlusion.hides(at(1e7, 40), 1e6));
    }
    // The wall's end is that of a block and of a tile; a ball of less than half a pixel.
    const Occlusion occlusion(wallDrawn(tiler, bins, node, view, 32), view, kTolerance);
    const double radius = 0.3 * 102 / view.pixels;
    EXPECT_TRUE(occlusion.hides(at(102, 0), radius));
    EXPECT_TRUE(occlusion.hides(at(102, 28.4), radius));
    EXPECT_FALSE(occlusion.hides(at(102, 30.5), radius));  // within the tolerance of the end
    EXPECT_FALSE(occlusion.hides(at(102, 40), radius));
    EXPECT_FALSE(occlusion.hides(at(102, -30.5), radius));
  });
}

// Where all nodes are of one level no border is stitched, so what is left out must change nothing at all.
TEST(Occlusion, leaves_every_bit_of_a_picture_of_one_level_as_it_is) {
  std::uint64_t occluded = 0, posts_left_out = 0;
  for (const MemoryDatabase& area : roughAreas()) {
    std::mt19937 random(47);
    for (int n = 0; n < viewsPerArea(24); ++n) {
      RenderOptions render;
      render.camera =
          n % 3 == 0 ? randomView(area.database, random, 160, 120) : lowView(area.database, random);
      // No multiple of a block, too.
      if (n % 4 == 1) render.camera.width = 158;
      render.keep_triangle_ids = true;
      if (n % 2 == 0) {
        render.tolerance = 0;
      } else {
        render.fixed_level = n % 3;
      }
      FrameStatistics with, without, all;
      const Picture picture = draw(EngineKind::kFast, area.database, render, with);
      render.occlusion = false;
      expectSamePicture(picture, draw(EngineKind::kFast, area.database, render, without), render.camera);
      render.cull = false;
      expectSamePicture(picture, draw(EngineKind::kFast, area.database, render, all), render.camera);
      EXPECT_EQ(findLoss(with), "");
      EXPECT_EQ(without.nodes.occluded, 0u);
      EXPECT_LE(with.nodes.visited, without.nodes.visited);
      EXPECT_LE(with.posts_decoded, without.posts_decoded);
      occluded += with.nodes.occluded;
      posts_left_out += without.posts_decoded - with.posts_decoded;
    }
  }
  EXPECT_GT(occluded, 100u);
  EXPECT_GT(posts_left_out, 10000u);
}

// With levels by error, what is hidden lets what is seen be coarser: both pictures keep the tolerance, so
// that they may differ by twice as much at silhouettes and nowhere show what lies behind.
TEST(Occlusion, opens_no_crack_between_levels) {
  constexpr int kReach = 3;  // pixels
  std::uint64_t occluded = 0, compared = 0;
  for (const MemoryDatabase& area : roughAreas()) {
    std::mt19937 random(53);
    for (int n = 0; n < viewsPerArea(12); ++n) {
      RenderOptions render;
      render.camera = lowView(area.database, random);
      FrameStatistics with, without;
      const Picture picture = draw(EngineKind::kFast, area.database, render, with);
      render.occlusion = false;
      const Picture whole = draw(EngineKind::kFast, area.database, render, without);
      occluded += with.nodes.occluded;
      EXPECT_EQ(findLoss(with), "");
      EXPECT_LE(with.projected_error, render.tolerance);
      for (int i = kReach; i + kReach < picture.height; ++i) {
        for (int j = kReach; j + kReach < picture.width; ++j) {
          const auto pixel = static_cast<std::size_t>(i * picture.width + j);
          // The farthest that the whole picture shows around.
          float farthest = 0;
          for (int y = i - kReach; y <= i + kReach; ++y) {
            for (int x = j - kReach; x <= j + kReach; ++x)
              farthest = std::max(farthest, whole.depth[static_cast<std::size_t>(y * picture.width + x)]);
          }
          ++compared;
          ASSERT_LE(picture.depth[pixel], farthest * 1.01F) << inWords(render.camera) << ' ' << j << ' ' << i;
        }
      }
    }
  }
  EXPECT_GT(occluded, 30u);
  EXPECT_GT(compared, 100000u);
}

TEST(Occlusion, depends_on_no_thread_and_no_vector_width) {
  const std::vector<MemoryDatabase> areas = roughAreas();
  std::uint64_t occluded = 0;
  for (const MemoryDatabase& area : {std::cref(areas[0]), std::cref(areas[2])}) {
    std::mt19937 random(59);
    for (int n = 0; n < viewsPerArea(4); ++n) {
      RenderOptions render;
      render.camera = lowView(area.database, random);
      render.keep_triangle_ids = true;
      render.threads = 1;
      FrameStatistics expected;
      const Picture picture = draw(EngineKind::kFast, area.database, render, expected);
      occluded += expected.nodes.occluded;
      onEverySimdTarget([&] {
        for (const int threads : {1, 2}) {
          render.threads = threads;
          FrameStatistics statistics;
          expectSamePicture(picture, draw(EngineKind::kFast, area.database, render, statistics),
                            render.camera);
          EXPECT_EQ(statistics.nodes.occluded, expected.nodes.occluded);
          EXPECT_EQ(statistics.nodes.visited, expected.nodes.visited);
          EXPECT_EQ(statistics.posts_decoded, expected.posts_decoded);
          EXPECT_EQ(statistics.triangles.in, expected.triangles.in);
          EXPECT_EQ(statistics.triangles.drawn, expected.triangles.drawn);
          EXPECT_EQ(statistics.triangles.hidden, expected.triangles.hidden);
          EXPECT_EQ(statistics.samples.tested, expected.samples.tested);
          EXPECT_EQ(statistics.samples.written, expected.samples.written);
        }
      });
    }
  }
  EXPECT_GT(occluded, 5u);
}

}  // namespace
}  // namespace deltaz
