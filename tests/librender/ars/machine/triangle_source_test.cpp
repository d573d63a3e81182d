#include "librender/ars/machine/triangle_source.h"

#include <algorithm>
#include <gtest/gtest.h>

#include "librender/ars/experiments/random_triangles.h"
#include "librender/ars/machine/machine.h"
#include "librender/ars/tiler/tiling_cursor.h"
#include "librender/ars/tiler/triangle_encoder.h"

namespace deltaz::ars {
namespace {

ProjectedTriangle randomCorners(RandomNumbers& random, bool needle) {
  ProjectedTriangle triangle = randomTriangle(
      random, {.side = random.uniform(5, 120), .needle_share = needle ? 1.0 : 0.0, .needle_length = 150});
  const double depth = random.uniform(0.1, 1);
  for (ProjectedVertex& vertex : triangle) {
    vertex.depth = depth * random.uniform(0.9, 1);
    vertex.color = random.uniform(0, 255);
  }
  return triangle;
}

TriangleStream smallStream(bool with_sources) {
  TriangleStream stream;
  stream.has_sources = with_sources;
  RandomNumbers random(6);
  for (const DrawPhase phase : {DrawPhase::kBackground, DrawPhase::kForeground, DrawPhase::kOverlay}) {
    TriangleBatch batch;
    batch.phase = phase;
    const bool background = phase != DrawPhase::kForeground;
    for (int k = 0; k < (background ? 20 : 300); ++k) {
      const ProjectedTriangle corners = randomCorners(random, k % 7 == 0);
      const EncodedTriangle encoded =
          encodeTriangle(corners, stream.profile, {.oversample = true, .background = background});
      batch.triangles.push_back(encodeTriangleWords(encoded.variables, stream.profile));
      if (with_sources) batch.sources.push_back(corners);
    }
    stream.batches.push_back(batch);
  }
  return stream;
}

TEST(TriangleSource, samples_what_the_tiling_machine_samples) {
  RandomNumbers random(20);
  for (const bool correct : {false, true}) {
    TilerConfiguration configuration;
    configuration.corrections = {.top_left_rule = correct, .clamp_depth = correct, .true_color = correct};
    for (int trial = 0; trial < 500; ++trial) {
      const EncodedTriangle encoded =
          encodeTriangle(randomCorners(random, trial % 3 == 0), configuration.numbers,
                         {.oversample = trial % 2 == 0, .background = trial % 5 == 0});
      TriangleSource source(configuration);
      source.add(encoded.variables, encoded.supplement);
      SampledTriangle sampled;
      source.sample(0, sampled);

      TilingCursor cursor(setUpTriangle(encoded.variables, configuration, &encoded.supplement),
                          configuration.numbers);
      std::size_t pixel = 0;
      std::int32_t samples = 0;
      while (!cursor.done()) {
        ++samples;
        const auto packet = cursor.sample();
        if (!packet) continue;
        ASSERT_LT(pixel, sampled.pixels.size());
        ASSERT_EQ(sampled.pixels[pixel].samples, samples);
        ASSERT_EQ(sampled.pixels[pixel].packet, *packet);
        ++pixel;
        samples = 0;
      }
      ASSERT_EQ(pixel, sampled.pixels.size());
      ASSERT_EQ(sampled.samples_after, samples);
    }
  }
}

TEST(TriangleSource, has_a_barrier_between_the_batches_of_a_stream) {
  const TriangleStream stream = smallStream(false);
  const Result<TriangleSource> source = triangleSource(stream, 0, 0, {});
  ASSERT_TRUE(source.ok());
  EXPECT_EQ(source.value().triangles(), 340U);
  EXPECT_EQ(source.value().barriers(), (std::vector<std::size_t>{20, 320}));
  EXPECT_EQ(triangleSource(stream, 1, 0, {}).value().triangles(), 0U);
  EXPECT_EQ(triangleSource(stream, 0, 1, {}).value().triangles(), 0U);
}

// Digest 14, row 12, on triangles: functional and timed, whatever the machine, the same bits.
TEST(TriangleSource, draws_a_stream_alike_timed_and_not) {
  const Result<TriangleSource> source = triangleSource(smallStream(false), 0, 0, {});
  ASSERT_TRUE(source.ok());
  // Background surfaces that cross would depend on the order of arrival among themselves; these are drawn by
  // one tiler.
  for (const bool brighter : {false, true}) {
    MachineConfiguration configuration;
    configuration.ties = brighter ? TieRule::kBrighter : TieRule::kFirstStays;
    configuration.buffer_triangles = 20;
    Machine functional = Machine::make(configuration).value();
    const MemoryCounts counts = functional.runFunctional(source.value());
    const std::vector<std::uint8_t> expected = functional.readPicture();
    EXPECT_GT(std::count_if(expected.begin(), expected.end(), [](int color) { return color != 0; }), 50'000);
    if (!brighter && counts.split_ties > 0) continue;
    for (const int tilers : {1, 4, 8}) {
      configuration.tilers = tilers;
      Machine timed = Machine::make(configuration).value();
      const Result<PassStatistics> statistics = timed.runTimed(source.value());
      ASSERT_TRUE(statistics.ok()) << statistics.error().message();
      EXPECT_EQ(statistics.value().barriers, 2);
      EXPECT_EQ(statistics.value().memoryCounts().writes(), counts.writes());
      EXPECT_TRUE(timed.readPicture() == expected) << tilers;
    }
  }
}

TEST(TriangleSource, encodes_a_stream_again_in_other_numbers_if_it_has_its_triangles) {
  TilerConfiguration coarse;
  coarse.numbers = withVertexFractionBits(coarse.numbers, 2);
  const Result<TriangleSource> refused = triangleSource(smallStream(false), 0, 0, coarse);
  ASSERT_FALSE(refused.ok());
  EXPECT_EQ(refused.error().kind, ErrorKind::kUsage);
  const Result<TriangleSource> source = triangleSource(smallStream(true), 0, 0, coarse);
  ASSERT_TRUE(source.ok());
  EXPECT_EQ(source.value().triangles(), 340U);
  Machine machine = Machine::make({}).value();
  EXPECT_GT(machine.runFunctional(source.value()).writes(), 100'000);

  TilerConfiguration clamped;
  clamped.corrections.clamp_depth = true;
  EXPECT_FALSE(triangleSource(smallStream(false), 0, 0, clamped).ok());
  EXPECT_TRUE(triangleSource(smallStream(true), 0, 0, clamped).ok());
}

}  // namespace
}  // namespace deltaz::ars
