#include "librender/ars/machine/tiler_pipeline.h"

#include <gtest/gtest.h>
#include <vector>

namespace deltaz::ars {
namespace {

constexpr Picoseconds kSetUp = 9750 * kNanosecond;

// Triangles of which every sample is a pixel.
RecordedPixels fullTriangles(std::size_t triangles, int pixels) {
  RecordedPixels source;
  for (std::size_t k = 0; k < triangles; ++k) {
    RecordedPixels::Triangle triangle;
    triangle.set_up = kSetUp;
    triangle.sampled.pixels.assign(static_cast<std::size_t>(pixels), SampledPixel{});
    source.list.push_back(triangle);
  }
  return source;
}

// When each pixel came into the FIFO, if one is taken every `period` from `first` on.
std::vector<Picoseconds> takeAll(TilerPipeline& tiler, Picoseconds first, Picoseconds period) {
  std::vector<Picoseconds> times;
  for (Picoseconds now = first; tiler.ready() != kNever; now += period) {
    now = std::max(now, tiler.ready());
    times.push_back(tiler.ready());
    tiler.take(now);
  }
  EXPECT_TRUE(tiler.finished());
  return times;
}

TilerStatistics statisticsOf(const TilerPipeline& tiler) {
  const TilerStatistics statistics = tiler.statistics(tiler.idleAt() + kMicrosecond);
  for (const UnitTimes& times : {statistics.transfer, statistics.set_up, statistics.tiling})
    EXPECT_EQ(times.sum(), tiler.idleAt() + kMicrosecond);
  return statistics;
}

const MemoryMap kMap(8, HashingMode::kScramble);

// Report 7.1.2.1: set-up, 0.7 us of loading, 100 ns a sample.
TEST(TilerPipeline, makes_the_first_pixel_after_set_up_loading_and_a_sample) {
  const RecordedPixels source = fullTriangles(1, 3);
  TilerPipeline tiler(0, source, kMap, {});
  tiler.assign(0, 1, 0);
  EXPECT_EQ(takeAll(tiler, 0, 0),
            (std::vector{10'550 * kNanosecond, 10'650 * kNanosecond, 10'750 * kNanosecond}));
}

// Digest 6.4: t = max(set-up, 0.7 + 0.1 x samples) us a triangle.
TEST(TilerPipeline, goes_at_the_pace_of_the_slower_stage) {
  for (const int pixels : {1, 50, 90, 91, 150, 400}) {
    const RecordedPixels source = fullTriangles(20, pixels);
    TilerPipeline tiler(0, source, kMap, {});
    tiler.assign(0, 20, 0);
    const std::vector<Picoseconds> times = takeAll(tiler, 0, 0);
    const Picoseconds step = std::max(kSetUp, (700 + 100 * pixels) * kNanosecond);
    EXPECT_EQ(times[static_cast<std::size_t>(19 * pixels)] - times[static_cast<std::size_t>(9 * pixels)],
              10 * step)
        << pixels;
    const TilerStatistics statistics = statisticsOf(tiler);
    EXPECT_EQ(statistics.samples, 20 * pixels);
    EXPECT_EQ(statistics.pixels, 20 * pixels);
    EXPECT_EQ(statistics.set_up.busy, 20 * kSetUp);
    EXPECT_EQ(statistics.loading, 20 * 700 * kNanosecond);
  }
}

// Digest 15: 102,564 triangles a second.
TEST(TilerPipeline, sets_up_no_more_than_102564_triangles_a_second) {
  const RecordedPixels source = fullTriangles(1000, 1);
  TilerPipeline tiler(0, source, kMap, {});
  tiler.assign(0, 1000, 0);
  takeAll(tiler, 0, 0);
  const double seconds = static_cast<double>(tiler.idleAt()) * 1e-12;
  EXPECT_NEAR(1000 / seconds, 102'564, 102'564 * 0.001);
}

TEST(TilerPipeline, takes_longer_with_a_slower_clock) {
  const RecordedPixels source = fullTriangles(3, 200);
  Picoseconds at_full = 0;
  for (const int percent : {100, 75, 50, 25}) {
    TilerPipelineTiming timing;
    timing.clock_percent = percent;
    TilerPipeline tiler(0, source, kMap, timing);
    tiler.assign(0, 3, 0);
    takeAll(tiler, 0, 0);
    if (percent == 100) at_full = tiler.idleAt();
    EXPECT_NEAR(static_cast<double>(tiler.idleAt()) * percent / 100, static_cast<double>(at_full),
                1e-5 * static_cast<double>(at_full));
  }
}

TEST(TilerPipeline, stops_when_its_output_is_full_and_goes_on_with_every_pixel_taken) {
  const RecordedPixels source = fullTriangles(1, 100);
  TilerPipelineTiming timing;
  timing.output_fifo = 4;
  TilerPipeline tiler(0, source, kMap, timing);
  tiler.assign(0, 1, 0);
  const Picoseconds first = 100 * kMicrosecond, period = kMicrosecond;
  const std::vector<Picoseconds> times = takeAll(tiler, first, period);
  for (std::size_t k = 0; k < 4; ++k)
    EXPECT_EQ(times[k], (10'450 + 100 * static_cast<Picoseconds>(k + 1)) * kNanosecond);
  // Pixel k gets the place of pixel k - 4.
  for (std::size_t k = 4; k < 100; ++k)
    EXPECT_EQ(times[k], first + static_cast<Picoseconds>(k - 4) * period) << k;
  const TilerStatistics statistics = statisticsOf(tiler);
  EXPECT_EQ(statistics.output_high_water, 4);
  EXPECT_EQ(statistics.tiling.busy, (700 + 100 * 100) * kNanosecond);
  EXPECT_GT(statistics.tiling.blocked, 80 * kMicrosecond);
}

// With everything behind stuck: one triangle tiled, five set up before it, one held by set-up, two
// transferred.
TEST(TilerPipeline, lets_eight_triangles_wait_behind_the_one_it_is_stuck_with) {
  const RecordedPixels source = fullTriangles(50, 100);
  TilerPipelineTiming timing;
  timing.output_fifo = 1;
  timing.transfer = kMicrosecond;
  TilerPipeline tiler(0, source, kMap, timing);
  tiler.assign(0, 9, 0);
  EXPECT_NE(tiler.transferred(), kNever);
  TilerPipeline fuller(0, source, kMap, timing);
  fuller.assign(0, 10, 0);
  EXPECT_EQ(fuller.transferred(), kNever);
  takeAll(fuller, 0, 0);
  EXPECT_NE(fuller.transferred(), kNever);
  EXPECT_GT(statisticsOf(fuller).transfer.blocked, 0);
}

TEST(TilerPipeline, starves_between_buffers) {
  const RecordedPixels source = fullTriangles(2, 10);
  TilerPipeline tiler(0, source, kMap, {});
  tiler.assign(0, 1, 5 * kMicrosecond);
  takeAll(tiler, 0, 0);
  tiler.assign(1, 2, 100 * kMicrosecond);
  const std::vector<Picoseconds> times = takeAll(tiler, 0, 0);
  EXPECT_EQ(times.front(), 100 * kMicrosecond + kSetUp + 800 * kNanosecond);
  EXPECT_EQ(statisticsOf(tiler).transfer.starved, tiler.idleAt() + kMicrosecond);
}

TEST(TilerPipeline, sends_pixels_to_their_places) {
  RecordedPixels source = fullTriangles(1, 1);
  source.list[0].sampled.pixels[0] = {.samples = 3,
                                      .packet = {.i = 100, .j = 33, .color = 7, .depth = 0xABCDEF}};
  TilerPipeline tiler(2, source, kMap, {});
  tiler.assign(0, 1, 0);
  const TreePixel pixel = tiler.take(tiler.ready());
  EXPECT_EQ(pixel.memory, kMap.memory(100, 33));
  EXPECT_EQ(pixel.address, 100U * 512 + 33);
  EXPECT_EQ(pixel.word, 0xABCDEF07U);
  EXPECT_EQ(pixel.tiler, 2);
}

}  // namespace
}  // namespace deltaz::ars
