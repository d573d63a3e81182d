#include "librender/ars/engine/scene_triangles.h"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <limits>
#include <set>

#include "librender/ars/engine/vertex_color.h"
#include "tests/librender/test_databases.h"
#include "tests/support/small_area.h"

namespace deltaz::ars {
namespace {

SceneTriangles trianglesOf(const Database& database, const RenderOptions& options,
                           FrameStatistics& statistics) {
  Result<Environment> environment = makeEnvironment(database, options);
  EXPECT_TRUE(environment.ok());
  Result<SceneTriangles> made = sceneTriangles(database, environment.value(), options, statistics);
  EXPECT_TRUE(made.ok());
  return std::move(made).value();
}

// The machine is handed what the fast engine draws, level by level, stitched and tested.
TEST(SceneTriangles, are_the_faces_the_fast_engine_draws) {
  const MemoryDatabase area = makeDatabase(smallArea());
  for (const double tolerance : {0.0, 2.0, 20.0}) {
    RenderOptions options;
    options.camera = cameraOver(area.database, 0.4, 0.3, 300, 40, -15, 160, 100);
    options.tolerance = tolerance;
    options.occlusion = false;
    options.keep_triangle_ids = true;
    FrameStatistics fast, ours;
    const Picture picture = draw(EngineKind::kFast, area.database, options, fast);
    const SceneTriangles scene = trianglesOf(area.database, options, ours);
    EXPECT_EQ(ours.triangles.in, fast.triangles.in);
    EXPECT_EQ(ours.triangles.back_facing, fast.triangles.back_facing);
    EXPECT_EQ(scene.triangles.size(), fast.triangles.in - fast.triangles.back_facing);
    EXPECT_EQ(scene.identity.size(), scene.triangles.size());
    EXPECT_EQ(ours.nodes.drawn, fast.nodes.drawn);
    EXPECT_EQ(ours.projected_error, fast.projected_error);
    const std::set<std::uint64_t> names(scene.identity.begin(), scene.identity.end());
    for (std::size_t k = 0; k < picture.surface.size(); ++k) {
      if (picture.surface[k] != Surface::kTerrain) continue;
      EXPECT_EQ(names.count(picture.triangle[k]), 1);
    }
  }
}

TEST(SceneTriangles, vertices_look_as_pixels_at_their_place_do) {
  const MemoryDatabase area = makeDatabase(smallArea());
  RenderOptions options;
  options.camera = cameraOver(area.database, 0.5, 0.5, 2500, 0, -89, 200, 200);
  options.tolerance = 0;
  FrameStatistics statistics;
  const Picture picture = draw(EngineKind::kReference, area.database, options);
  const SceneTriangles scene = trianglesOf(area.database, options, statistics);
  const ViewTransform view = makeEnvironment(area.database, options).value().view;
  std::size_t compared = 0, near = 0;
  for (const ViewTriangle& triangle : scene.triangles) {
    const ViewVertex& v = triangle.vertex[0];
    const double j = view.centre_j + v.v / v.u, i = view.centre_i + v.w / v.u;
    if (!(j > 1 && j < 198 && i > 1 && i < 198)) continue;
    const auto pixel =
        static_cast<std::size_t>(std::lround(i)) * 200 + static_cast<std::size_t>(std::lround(j));
    if (picture.surface[pixel] != Surface::kTerrain) continue;
    ++compared;
    double largest = 0;
    for (std::size_t c = 0; c < kColors; ++c)
      largest = std::max(largest, std::abs(v.color[c] - picture.rgb[3 * pixel + c]));
    near += largest < 12;
  }
  ASSERT_GT(compared, 300);
  EXPECT_GT(static_cast<double>(near), 0.95 * static_cast<double>(compared));
}

// A sky, a horizon and a sea: every pixel belongs to a triangle whose colours meet what is there.
TEST(BackgroundTriangles, cover_every_pixel_once_with_what_it_shows) {
  const MemoryDatabase area = makeDatabase(smallArea());
  RenderOptions options;
  options.camera = cameraOver(area.database, 0.5, 0.5, 5000, 30, -2, 300, 200);
  options.camera.roll = 10;
  const Environment environment = makeEnvironment(area.database, options).value();
  const std::vector<BackgroundTriangle> triangles = backgroundTriangles(environment, 20, 30, 160, 240);
  std::vector<double> error(160 * 240, std::numeric_limits<double>::infinity());
  for (const BackgroundTriangle& t : triangles) {
    const auto& [a, b, c] = t.corner;
    const double area2 = (b.i - a.i) * (c.j - a.j) - (c.i - a.i) * (b.j - a.j);
    ASSERT_NE(area2, 0);
    for (auto i = static_cast<int>(std::min({a.i, b.i, c.i})); i <= std::max({a.i, b.i, c.i}); ++i) {
      for (auto j = static_cast<int>(std::min({a.j, b.j, c.j})); j <= std::max({a.j, b.j, c.j}); ++j) {
        const double second = ((i - a.i) * (c.j - a.j) - (c.i - a.i) * (j - a.j)) / area2;
        const double third = ((b.i - a.i) * (j - a.j) - (i - a.i) * (b.j - a.j)) / area2;
        if (second < -1e-9 || third < -1e-9 || second + third > 1 + 1e-9) continue;
        const Vector3 ray = environment.view.ray(30 + j, 20 + i);
        const double u = environment.sea.depth(ray);
        const bool sky = !(u < std::numeric_limits<double>::infinity());
        const auto is = displayedColor(
            sky ? environment.atmosphere.sky(ray)
                : seenColor(environment, ray, Surface::kSea, u, environment.sea.color(ray, u)));
        double largest = 0;
        for (std::size_t k = 0; k < kColors; ++k) {
          const double shown = t.color[0][k] + (t.color[1][k] - t.color[0][k]) * second +
                               (t.color[2][k] - t.color[0][k]) * third;
          largest = std::max(largest, std::abs(shown - is[k]));
        }
        const bool small = std::max({a.i, b.i, c.i}) - std::min({a.i, b.i, c.i}) <= kSmallestBackground &&
                           std::max({a.j, b.j, c.j}) - std::min({a.j, b.j, c.j}) <= kSmallestBackground;
        if (i >= 160 || j >= 240) continue;
        double& of_pixel = error[static_cast<std::size_t>(i) * 240 + static_cast<std::size_t>(j)];
        EXPECT_EQ(of_pixel, std::numeric_limits<double>::infinity()) << "drawn twice";
        of_pixel = small ? 0 : largest;
      }
    }
  }
  // Looked at in a lattice, so that between its places a little more is let through.
  for (const double e : error) EXPECT_LE(e, kBackgroundStep + 0.5);
  EXPECT_LT(triangles.size(), 8000);
}

}  // namespace
}  // namespace deltaz::ars
