#include <cmath>
#include <gtest/gtest.h>
#include <limits>

#include "libdb/access/simd_target.h"
#include "tests/librender/picture_comparison.h"
#include "tests/librender/test_databases.h"

namespace deltaz {
namespace {

constexpr double kSnapDistance = 1.0 / 256;  // pixels

RenderOptions optionsOf(const Camera& camera) {
  RenderOptions options;
  options.camera = camera;
  options.tolerance = 0;
  options.keep_triangle_ids = true;
  return options;
}

void expectSamePicture(const Database& database, const RenderOptions& options) {
  const Picture fast = draw(EngineKind::kFast, database, options);
  const Picture reference = draw(EngineKind::kReference, database, options);
  const PictureDifference difference = comparePictures(database, options.camera, fast, reference);
  EXPECT_LE(static_cast<double>(difference.differing), 0.001 * static_cast<double>(difference.pixels));
  EXPECT_LE(difference.farthest_from_edge, kSnapDistance);
  EXPECT_LT(difference.largest_depth_difference, 1e-3);
}

TEST(Engines, draw_the_same_picture_of_the_whole_area) {
  const MemoryDatabase area = makeDatabase(smallArea());
  expectSamePicture(area.database, optionsOf(wholeAreaCamera(area.database.area(), 320, 200, 60)));
}

TEST(Engines, pictures_and_counts_do_not_depend_on_vector_width_or_threads) {
  const MemoryDatabase area = makeDatabase(smallArea());
  for (const Camera& camera : {wholeAreaCamera(area.database.area(), 321, 203, 60),
                               cameraOver(area.database, 0.41, 0.37, 1.7, 45, -3, 320, 200)}) {
    RenderOptions options = optionsOf(camera);
    options.tolerance = 1;
    options.threads = 1;
    FrameStatistics expected;
    const Result<Picture> first = makeEngine(EngineKind::kFast)->render(area.database, options, expected);
    ASSERT_TRUE(first.ok());
    const auto expect_same = [&] {
      FrameStatistics counts;
      const Result<Picture> picture = makeEngine(EngineKind::kFast)->render(area.database, options, counts);
      ASSERT_TRUE(picture.ok());
      EXPECT_EQ(picture.value().rgb, first.value().rgb);
      EXPECT_EQ(picture.value().depth, first.value().depth);
      EXPECT_EQ(picture.value().triangle, first.value().triangle);
      EXPECT_EQ(counts.samples.tested, expected.samples.tested);
      EXPECT_EQ(counts.samples.written, expected.samples.written);
      EXPECT_EQ(counts.samples.shaded, expected.samples.shaded);
      EXPECT_EQ(counts.triangles.drawn, expected.triangles.drawn);
      EXPECT_EQ(counts.triangles.no_sample, expected.triangles.no_sample);
    };
    for (const SimdTarget target : simdTargets()) {
      SCOPED_TRACE(simdTargetName(target));
      ASSERT_TRUE(limitSimdTarget(target));
      expect_same();
    }
    limitSimdTarget(std::nullopt);
    for (const int threads : {2, 7}) {
      options.threads = threads;
      expect_same();
    }
  }
}

TEST(Engines, draw_the_same_picture_at_eye_level) {
  const MemoryDatabase area = makeDatabase(smallArea());
  for (const double heading : {0.0, 45.0, 135.0, 200.0, 290.0}) {
    Camera camera = cameraOver(area.database, 0.41, 0.37, 1.7, heading, -3, 320, 200);
    camera.roll = heading / 20;
    expectSamePicture(area.database, optionsOf(camera));
  }
}

TEST(Engines, draw_the_same_picture_from_straight_above_and_with_voids) {
  for (const VoidPattern voids : {VoidPattern::kScattered, VoidPattern::kHole, VoidPattern::kWestHalf}) {
    SyntheticGridOptions options = smallArea();
    options.voids = voids;
    const MemoryDatabase area = makeDatabase(options);
    expectSamePicture(area.database, optionsOf(cameraOver(area.database, 0.5, 0.5, 9000, 30, -90, 320, 200)));
    expectSamePicture(area.database, optionsOf(cameraOver(area.database, 0.9, 0.1, 300, 315, -10, 320, 200)));
  }
}

TEST(Engines, draw_the_same_picture_at_the_poles_the_antimeridian_and_the_equator) {
  struct Place {
    double south, west;
    Rational spacing;
  };
  for (const Place& place : {Place{89, 20, {30, 1}}, Place{-90, 100, {30, 1}}, Place{10, 179.5, {30, 1}},
                             Place{-0.5, 9, {30, 1}}}) {
    SyntheticGridOptions options;
    options.south = place.south;
    options.west = place.west;
    options.spacing_latitude = options.spacing_longitude = place.spacing;
    const MemoryDatabase area = makeDatabase(options);
    expectSamePicture(area.database, optionsOf(wholeAreaCamera(area.database.area(), 320, 200, 60)));
    expectSamePicture(area.database, optionsOf(cameraOver(area.database, 0.5, 0.4, 200, 10, -5, 320, 200)));
  }
}

// Local is as good as exact to the eye; delta and matrix are off by the Earth's curvature inside a node. Both
// say so.
TEST(Engines, draw_with_other_transforms_what_they_state) {
  const MemoryDatabase area = makeDatabase(smallArea(), 64);
  RenderOptions options = optionsOf(cameraOver(area.database, 0.4, 0.1, 3000, 10, -20, 320, 200));
  FrameStatistics of_exact;
  const Picture exact = draw(EngineKind::kFast, area.database, options, of_exact);
  EXPECT_EQ(of_exact.transform_error, 0);
  const auto differing = [&](const Picture& picture) {
    std::size_t count = 0;
    for (std::size_t k = 0; k < exact.triangle.size(); ++k)
      count += exact.triangle[k] == picture.triangle[k] ? 0 : 1;
    return static_cast<double>(count) / static_cast<double>(exact.triangle.size());
  };
  double of_local = 0, differing_local = 0;
  for (const TransformKind kind : {TransformKind::kLocal, TransformKind::kDelta, TransformKind::kMatrix}) {
    options.transform = kind;
    FrameStatistics statistics;
    const Picture picture = draw(EngineKind::kFast, area.database, options, statistics);
    EXPECT_GT(statistics.transform_error, 0) << transformName(kind);
    EXPECT_EQ(statistics.projected_error, of_exact.projected_error + statistics.transform_error);
    if (kind == TransformKind::kLocal) {
      of_local = statistics.transform_error;
      EXPECT_LT(of_local, 0.1);
      differing_local = differing(picture);
      EXPECT_LT(differing_local, 0.001);
    } else {
      EXPECT_GT(statistics.transform_error, 10 * of_local) << transformName(kind);
      EXPECT_GT(differing(picture), 5 * differing_local) << transformName(kind);
      EXPECT_GT(differing(picture), 0.001) << transformName(kind);
    }
  }
}

TEST(Engines, account_for_every_triangle) {
  const MemoryDatabase area = makeDatabase(smallArea());
  for (const EngineKind kind : {EngineKind::kFast, EngineKind::kReference}) {
    for (const double above : {1.7, 500.0, 20000.0}) {
      FrameStatistics statistics;
      const double pitch = above > 1000 ? -90 : -20;
      draw(kind, area.database, optionsOf(cameraOver(area.database, 0.3, 0.3, above, 40, pitch, 200, 120)),
           statistics);
      const FrameStatistics::Triangles& t = statistics.triangles;
      EXPECT_GT(t.in, 0u);
      EXPECT_EQ(t.in, t.back_facing + t.clipped + t.no_sample + t.drawn);
      EXPECT_LE(statistics.samples.written, statistics.samples.tested);
      EXPECT_LE(statistics.samples.shaded, statistics.samples.written);
      EXPECT_GE(statistics.depth_complexity, statistics.samples.tested > 0 ? 1.0 : 0.0);
      EXPECT_GT(statistics.posts_decoded, 0u);
      EXPECT_GT(statistics.bytes_read, 0u);
    }
  }
}

TEST(FastEngine, picture_does_not_depend_on_the_number_of_threads) {
  const MemoryDatabase area = makeDatabase(smallArea());
  RenderOptions options = optionsOf(cameraOver(area.database, 0.4, 0.4, 50, 70, -8, 333, 211));
  options.threads = 1;
  FrameStatistics first_statistics;
  const Picture first = draw(EngineKind::kFast, area.database, options, first_statistics);
  for (const int threads : {2, 7}) {
    options.threads = threads;
    FrameStatistics statistics;
    const Picture picture = draw(EngineKind::kFast, area.database, options, statistics);
    EXPECT_EQ(picture.rgb, first.rgb);
    EXPECT_EQ(picture.depth, first.depth);
    EXPECT_EQ(picture.surface, first.surface);
    EXPECT_EQ(picture.triangle, first.triangle);
    EXPECT_EQ(statistics.triangles.drawn, first_statistics.triangles.drawn);
    EXPECT_EQ(statistics.samples.written, first_statistics.samples.written);
  }
}

TEST(ReferenceEngine, picture_does_not_depend_on_the_number_of_threads) {
  const MemoryDatabase area = makeDatabase(smallArea());
  RenderOptions options = optionsOf(cameraOver(area.database, 0.4, 0.4, 50, 70, -8, 333, 211));
  options.threads = 1;
  const Picture first = draw(EngineKind::kReference, area.database, options);
  options.threads = 7;
  const Picture picture = draw(EngineKind::kReference, area.database, options);
  EXPECT_EQ(picture.rgb, first.rgb);
  EXPECT_EQ(picture.triangle, first.triangle);
}

TEST(Engines, tell_terrain_sea_and_sky_apart) {
  const MemoryDatabase area = makeDatabase(smallArea());
  for (const EngineKind kind : {EngineKind::kFast, EngineKind::kReference}) {
    const Picture picture =
        draw(kind, area.database, optionsOf(cameraOver(area.database, 0.5, -0.3, 800, 0, 0, 160, 120)));
    bool seen[3] = {};
    for (std::size_t pixel = 0; pixel < picture.surface.size(); ++pixel) {
      const Surface surface = picture.surface[pixel];
      seen[static_cast<int>(surface)] = true;
      EXPECT_EQ(std::isinf(picture.depth[pixel]), surface == Surface::kSky);
      EXPECT_EQ(picture.triangle[pixel] != 0, surface == Surface::kTerrain);
    }
    EXPECT_TRUE(seen[0] && seen[1] && seen[2]);
  }
}

// Flat land far below the horizon is behind the sea; the same land within the horizon is seen.
TEST(Engines, the_sea_hides_what_is_behind_the_horizon) {
  SyntheticGridOptions grid;
  grid.south = 45;
  grid.west = 7;
  grid.spacing_latitude = grid.spacing_longitude = {3, 1};
  grid.lowest = 0;
  grid.highest = 3;
  const MemoryDatabase area = makeDatabase(grid);
  for (const EngineKind kind : {EngineKind::kFast, EngineKind::kReference}) {
    for (const bool behind : {false, true}) {
      Camera camera = cameraOver(area.database, 0.5, 0, 0, 0, 0, 200, 100);
      camera.eye.height = 40;
      camera.eye.latitude -= behind ? 0.6 : 0.1;  // 67 km; the horizon is at 23 km
      camera.field_of_view = 10;
      const Picture picture = draw(kind, area.database, optionsOf(camera));
      const auto terrain = std::count(picture.surface.begin(), picture.surface.end(), Surface::kTerrain);
      if (behind) {
        EXPECT_EQ(terrain, 0);
      } else {
        EXPECT_GT(terrain, 0);
      }
    }
  }
}

TEST(FastEngine, fixed_level_draws_that_level) {
  const MemoryDatabase area = makeDatabase(smallArea());
  RenderOptions options = optionsOf(wholeAreaCamera(area.database.area(), 320, 200, 60));
  std::uint64_t before = std::numeric_limits<std::uint64_t>::max();
  for (int level = 0; level < area.database.grid(0).header().level_count; ++level) {
    options.fixed_level = level;
    FrameStatistics statistics;
    draw(EngineKind::kFast, area.database, options, statistics);
    EXPECT_EQ(statistics.level, level);
    EXPECT_LT(statistics.triangles.in, before);
    before = statistics.triangles.in;
  }
}

TEST(Engines, refuse_views_that_make_no_sense) {
  const MemoryDatabase area = makeDatabase(smallArea());
  const auto refused = [&](auto&& change) {
    RenderOptions options = optionsOf(cameraOver(area.database, 0.5, 0.5, 100, 0, 0, 64, 48));
    change(options);
    FrameStatistics statistics;
    for (const EngineKind kind : {EngineKind::kFast, EngineKind::kReference}) {
      const Result<Picture> picture = makeEngine(kind)->render(area.database, options, statistics);
      EXPECT_FALSE(picture.ok());
      if (!picture.ok()) {
        EXPECT_EQ(picture.error().kind, ErrorKind::kUsage);
      }
    }
  };
  refused([](RenderOptions& o) { o.camera.width = 0; });
  refused([](RenderOptions& o) { o.camera.height = 1 << 20; });
  refused([](RenderOptions& o) { o.camera.field_of_view = 180; });
  refused([](RenderOptions& o) { o.camera.field_of_view = 0; });
  refused([](RenderOptions& o) { o.camera.eye.latitude = 91; });
  refused([](RenderOptions& o) { o.camera.heading = std::numeric_limits<double>::quiet_NaN(); });
  refused([](RenderOptions& o) { o.tolerance = -1; });
}

}  // namespace
}  // namespace deltaz
