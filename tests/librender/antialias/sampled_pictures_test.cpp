// Pictures with several samples a pixel, as the engines draw them.
#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <string>
#include <vector>

#include "librender/scene/conservation.h"
#include "librender/sweep/picture_error.h"
#include "tests/librender/test_databases.h"
#include "tests/support/every_simd_target.h"

namespace deltaz {
namespace {

RenderOptions optionsOf(const Camera& camera, const Sampling& sampling) {
  RenderOptions options;
  options.camera = camera;
  options.tolerance = 0;
  options.sampling = sampling;
  options.keep_triangle_ids = true;
  return options;
}

// Ground to the horizon, sea and sky: all that silhouettes are made of. Sizes are no multiples of tiles.
std::vector<Camera> camerasOver(const Database& database) {
  Camera turned = cameraOver(database, 0.3, 0.2, 400, 40, -8, 77, 51);
  turned.roll = 20;
  return {cameraOver(database, 0.41, 0.37, 1.7, 45, -3, 81, 53), turned,
          cameraOver(database, 0.5, 0.5, 60000, 0, -70, 77, 51),
          cameraOver(database, 0.5, 0.9, 300, 0, -2, 80, 50)};
}

std::string nameOf(const Sampling& sampling) {
  return std::to_string(sampling.count) + " " + std::string(samplePatternName(sampling.pattern)) + " " +
         std::string(filterName(sampling.filter));
}

// The reference shades each sample by itself, the fast engine what samples of a pixel have in common once.
TEST(SampledPictures, of_both_engines_are_the_same) {
  const MemoryDatabase area = makeDatabase(smallArea());
  for (const Sampling& sampling : {Sampling{4, SamplePattern::kRotated, FilterKind::kBox},
                                   Sampling{4, SamplePattern::kOrdered, FilterKind::kPyramid},
                                   Sampling{16, SamplePattern::kRotated, FilterKind::kGaussian},
                                   Sampling{64, SamplePattern::kRotated, FilterKind::kMitchell},
                                   Sampling{1, SamplePattern::kRotated, FilterKind::kMitchell}}) {
    SCOPED_TRACE(nameOf(sampling));
    for (const Camera& camera : camerasOver(area.database)) {
      const Picture fast = draw(EngineKind::kFast, area.database, optionsOf(camera, sampling));
      const Picture reference = draw(EngineKind::kReference, area.database, optionsOf(camera, sampling));
      const PictureError error = comparePictures(fast, reference);
      EXPECT_LT(error.differingShare(), 0.004);
      EXPECT_GT(error.peakSignalToNoise(), 50);
      std::size_t other_surface = 0, other_face = 0;
      double largest_depth = 0;
      for (std::size_t k = 0; k < fast.surface.size(); ++k) {
        other_surface += fast.surface[k] == reference.surface[k] ? 0 : 1;
        other_face += fast.triangle[k] == reference.triangle[k] ? 0 : 1;
        if (fast.triangle[k] != reference.triangle[k] || fast.surface[k] != reference.surface[k] ||
            fast.surface[k] == Surface::kSky)
          continue;
        largest_depth = std::max(
            largest_depth,
            std::abs(static_cast<double>(fast.depth[k]) / static_cast<double>(reference.depth[k]) - 1));
      }
      EXPECT_LE(other_surface, fast.surface.size() / 500);
      EXPECT_LE(other_face, fast.surface.size() / 200);
      EXPECT_LT(largest_depth, 1e-3);
    }
  }
}

TEST(SampledPictures, and_their_counts_do_not_depend_on_vector_width_or_threads) {
  const MemoryDatabase area = makeDatabase(smallArea());
  const Camera camera = cameraOver(area.database, 0.41, 0.37, 50, 45, -3, 321, 203);
  for (const Sampling& sampling : {Sampling{4, SamplePattern::kRotated, FilterKind::kBox},
                                   Sampling{16, SamplePattern::kRotated, FilterKind::kMitchell}}) {
    RenderOptions options = optionsOf(camera, sampling);
    options.tolerance = 1;
    options.threads = 1;
    FrameStatistics expected;
    const Picture first = draw(EngineKind::kFast, area.database, options, expected);
    const auto expect_same = [&] {
      FrameStatistics counts;
      const Picture picture = draw(EngineKind::kFast, area.database, options, counts);
      EXPECT_EQ(picture.rgb, first.rgb);
      EXPECT_EQ(picture.depth, first.depth);
      EXPECT_EQ(picture.triangle, first.triangle);
      EXPECT_EQ(counts.samples.tested, expected.samples.tested);
      EXPECT_EQ(counts.samples.written, expected.samples.written);
      EXPECT_EQ(counts.samples.shaded, expected.samples.shaded);
      EXPECT_EQ(counts.triangles.no_sample, expected.triangles.no_sample);
    };
    onEverySimdTarget(expect_same);
    for (const int threads : {2, 7}) {
      options.threads = threads;
      expect_same();
    }
  }
}

TEST(SampledPictures, one_sample_is_the_same_in_either_pattern) {
  const MemoryDatabase area = makeDatabase(smallArea());
  for (const Camera& camera : camerasOver(area.database)) {
    const Picture rotated = draw(EngineKind::kFast, area.database,
                                 optionsOf(camera, {1, SamplePattern::kRotated, FilterKind::kBox}));
    const Picture ordered = draw(EngineKind::kFast, area.database,
                                 optionsOf(camera, {1, SamplePattern::kOrdered, FilterKind::kBox}));
    EXPECT_EQ(rotated.rgb, ordered.rgb);
    // A pyramid reaches the neighbours' centres with nothing: the other resolver, but the same picture.
    const Picture pyramid = draw(EngineKind::kFast, area.database,
                                 optionsOf(camera, {1, SamplePattern::kOrdered, FilterKind::kPyramid}));
    EXPECT_EQ(pyramid.depth, ordered.depth);
    EXPECT_EQ(pyramid.triangle, ordered.triangle);
    EXPECT_LE(comparePictures(pyramid, ordered).largest, 1);
  }
}

TEST(SampledPictures, come_nearer_to_many_samples_the_more_they_have) {
  const MemoryDatabase area = makeDatabase(smallArea());
  for (const Camera& camera : camerasOver(area.database)) {
    for (const FilterKind filter : {FilterKind::kBox, FilterKind::kGaussian}) {
      const auto picture = [&](int count) {
        return draw(EngineKind::kFast, area.database,
                    optionsOf(camera, {count, SamplePattern::kRotated, filter}));
      };
      const Picture best = picture(64);
      const double of_one = comparePictures(picture(1), best).mean_square,
                   of_four = comparePictures(picture(4), best).mean_square,
                   of_sixteen = comparePictures(picture(16), best).mean_square;
      EXPECT_LT(of_four, of_one / 2);
      EXPECT_LT(of_sixteen, of_four / 2);
    }
  }
}

// Every filter leaves an even colour as it is, at the picture's border too.
TEST(SampledPictures, an_even_sky_stays_even) {
  const MemoryDatabase area = makeDatabase(smallArea());
  const Camera up = cameraOver(area.database, 0.5, 0.5, 500, 0, 80, 33, 21);
  const Picture plain = draw(EngineKind::kFast, area.database, optionsOf(up, {}));
  ASSERT_EQ(std::count(plain.surface.begin(), plain.surface.end(), Surface::kSky),
            static_cast<std::ptrdiff_t>(plain.surface.size()));
  for (const FilterKind filter : kFilterKinds) {
    for (const int count : kSampleCounts) {
      const Picture picture =
          draw(EngineKind::kFast, area.database, optionsOf(up, {count, SamplePattern::kRotated, filter}));
      EXPECT_LE(comparePictures(picture, plain).largest, 1);
      EXPECT_EQ(picture.surface, plain.surface);
    }
  }
}

// Depth is that of the pixel's centre, so that it does not matter to it how many samples there are.
TEST(SampledPictures, depth_is_that_of_one_sample_where_the_face_is_the_same) {
  const MemoryDatabase area = makeDatabase(smallArea());
  for (const Camera& camera : camerasOver(area.database)) {
    const Picture one = draw(EngineKind::kFast, area.database, optionsOf(camera, {}));
    for (const int count : {4, 16, 64}) {
      const Picture many = draw(EngineKind::kFast, area.database,
                                optionsOf(camera, {count, SamplePattern::kRotated, FilterKind::kBox}));
      std::size_t same = 0;
      for (std::size_t k = 0; k < one.depth.size(); ++k) {
        if (one.triangle[k] != many.triangle[k] || one.surface[k] != many.surface[k]) continue;
        ++same;
        if (one.surface[k] == Surface::kSky) continue;
        EXPECT_NEAR(static_cast<double>(many.depth[k]) / static_cast<double>(one.depth[k]), 1, 1e-5);
      }
      EXPECT_GT(same, one.depth.size() / 2);
    }
  }
}

TEST(SampledPictures, statistics_count_samples_and_lose_no_triangle) {
  const MemoryDatabase area = makeDatabase(smallArea());
  const Camera camera = cameraOver(area.database, 0.41, 0.37, 50, 45, -3, 160, 100);
  // What is found hidden depends on the samples there are.
  RenderOptions options = optionsOf(camera, {});
  options.occlusion = false;
  FrameStatistics of_one;
  draw(EngineKind::kFast, area.database, options, of_one);
  for (const int count : {4, 16, 64}) {
    FrameStatistics statistics;
    options.sampling.count = count;
    draw(EngineKind::kFast, area.database, options, statistics);
    EXPECT_EQ(findLoss(statistics), "");
    EXPECT_EQ(statistics.triangles.in, of_one.triangles.in);
    EXPECT_EQ(statistics.nodes.drawn, of_one.nodes.drawn);
    EXPECT_NEAR(static_cast<double>(statistics.samples.written) /
                    (count * static_cast<double>(of_one.samples.written)),
                1, 0.1);
    EXPECT_NEAR(statistics.depth_complexity, of_one.depth_complexity, 0.2 * of_one.depth_complexity);
    // A colour for most pixels, not for each sample.
    EXPECT_GE(statistics.samples.shaded, of_one.samples.shaded);
    EXPECT_LT(statistics.samples.shaded, 6 * of_one.samples.shaded);
    EXPECT_EQ(statistics.projected_error, of_one.projected_error);
  }
}

TEST(SampledPictures, of_other_tolerances_draw_the_levels_of_one_sample) {
  const MemoryDatabase area = makeDatabase(smallArea());
  for (const double tolerance : {0.5, 2.0}) {
    RenderOptions options = optionsOf(cameraOver(area.database, 0.5, 0.1, 3000, 0, -20, 160, 100), {});
    options.tolerance = tolerance;
    options.occlusion = false;
    FrameStatistics of_one, of_many;
    draw(EngineKind::kFast, area.database, options, of_one);
    options.sampling.count = 16;
    draw(EngineKind::kFast, area.database, options, of_many);
    EXPECT_EQ(of_many.triangles.in, of_one.triangles.in);
    EXPECT_EQ(of_many.level, of_one.level);
    EXPECT_NEAR(of_many.projected_error, of_one.projected_error, 1e-9);
  }
}

TEST(SampledPictures, do_not_depend_on_what_is_found_hidden) {
  const MemoryDatabase area = makeDatabase(smallArea());
  std::uint64_t occluded = 0;
  for (const int count : {4, 16}) {
    RenderOptions options = optionsOf(cameraOver(area.database, 0.41, 0.37, 1.7, 45, -3, 160, 100),
                                      {count, SamplePattern::kRotated, FilterKind::kGaussian});
    FrameStatistics statistics;
    const Picture skipping = draw(EngineKind::kFast, area.database, options, statistics);
    EXPECT_EQ(findLoss(statistics), "");
    occluded += statistics.nodes.occluded;
    options.occlusion = false;
    const Picture drawing = draw(EngineKind::kFast, area.database, options);
    EXPECT_EQ(skipping.rgb, drawing.rgb);
    EXPECT_EQ(skipping.depth, drawing.depth);
    EXPECT_EQ(skipping.triangle, drawing.triangle);
  }
  EXPECT_GT(occluded, 0U);
}

TEST(SampledPictures, of_numbers_and_sizes_there_are_not_are_refused) {
  const MemoryDatabase area = makeDatabase(smallArea());
  for (const EngineKind kind : {EngineKind::kFast, EngineKind::kReference}) {
    RenderOptions options = optionsOf(cameraOver(area.database, 0.5, 0.1, 3000, 0, -20, 16, 10), {});
    FrameStatistics unused;
    for (const int count : {0, 2, 5, -4, 256}) {
      options.sampling.count = count;
      const auto picture = makeEngine(kind)->render(area.database, options, unused);
      ASSERT_FALSE(picture.ok());
      EXPECT_NE(picture.error().message().find("1, 4, 16, 64"), std::string::npos);
    }
    options.sampling.count = 64;
    options.camera.width = 2049;
    const auto picture = makeEngine(kind)->render(area.database, options, unused);
    ASSERT_FALSE(picture.ok());
    EXPECT_NE(picture.error().message().find("2048"), std::string::npos);
  }
}

}  // namespace
}  // namespace deltaz
