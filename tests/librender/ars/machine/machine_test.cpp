#include "librender/ars/machine/machine.h"

#include <algorithm>
#include <array>
#include <gtest/gtest.h>
#include <random>

#include "tests/librender/ars/machine/random_pixels.h"

namespace deltaz::ars {
namespace {

constexpr std::array kModes = {HashingMode::kSequential, HashingMode::kInterleave, HashingMode::kScramble};

struct MachineRun {
  PassStatistics statistics;
  std::vector<std::uint8_t> picture;
};

MachineRun timedRun(const MachineConfiguration& configuration, const PixelSource& source) {
  MachineRun run;
  Result<Machine> machine = Machine::make(configuration);
  if (!machine.ok()) {
    ADD_FAILURE() << machine.error().message();
    return run;
  }
  const Result<PassStatistics> statistics = machine.value().runTimed(source);
  if (!statistics.ok()) {
    ADD_FAILURE() << statistics.error().message();
    return run;
  }
  run.statistics = statistics.value();
  run.picture = machine.value().readPicture();
  return run;
}

std::vector<std::uint8_t> functionalPicture(const MachineConfiguration& configuration,
                                            const PixelSource& source, MemoryCounts* counts = nullptr) {
  Machine machine = Machine::make(configuration).value();
  const MemoryCounts all = machine.runFunctional(source);
  if (counts != nullptr) *counts = all;
  return machine.readPicture();
}

// The z-buffer in four lines: largest depth wins.
std::vector<std::uint8_t> plainPicture(const RecordedPixels& source) {
  std::vector<std::uint8_t> picture(std::size_t{kScreenLines} * kScreenPixels);
  std::vector<std::uint32_t> nearest(picture.size());
  for (const RecordedPixels::Triangle& triangle : source.list) {
    for (const SampledPixel& pixel : triangle.sampled.pixels) {
      const std::size_t at = std::size_t{pixel.packet.i} * kScreenPixels + pixel.packet.j;
      if (pixel.packet.depth <= nearest[at]) continue;
      nearest[at] = pixel.packet.depth;
      picture[at] = pixel.packet.color;
    }
  }
  return picture;
}

RandomPixelOptions fewTriangles(unsigned seed) {
  return {.triangles = 250, .side = 90, .most_area = 0.1, .line_sigma = 60, .seed = seed};
}

TEST(Machine, default_is_the_reports) {
  const MachineConfiguration configuration;
  EXPECT_EQ(configuration.tilers, 4);
  EXPECT_EQ(configuration.memories, 8);
  EXPECT_EQ(configuration.queue_depth, 256);
  EXPECT_EQ(configuration.memory_fifo, 64);
  EXPECT_EQ(configuration.output_fifo, 64);
  EXPECT_EQ(configuration.transfer_fifo, 2);
  EXPECT_EQ(configuration.set_up_fifo, 5);
  EXPECT_TRUE(validate(configuration).ok());
}

TEST(Machine, refuses_what_cannot_be_built) {
  const auto refused = [](auto&& change) {
    MachineConfiguration configuration;
    change(configuration);
    const Status status = validate(configuration);
    return !status.ok() && status.error().kind == ErrorKind::kUsage && !Machine::make(configuration).ok();
  };
  EXPECT_TRUE(refused([](auto& c) { c.tilers = 3; }));
  EXPECT_TRUE(refused([](auto& c) { c.tilers = 128; }));
  EXPECT_TRUE(refused([](auto& c) { c.memories = 0; }));
  EXPECT_TRUE(refused([](auto& c) { c.queue_depth = -1; }));
  EXPECT_TRUE(refused([](auto& c) { c.memory_fifo = 0; }));
  EXPECT_TRUE(refused([](auto& c) { c.tiler_clock_percent = 0; }));
  EXPECT_TRUE(refused([](auto& c) { c.buffer_triangles = 0; }));
  EXPECT_TRUE(refused([](auto& c) { c.unavailable = {4}; }));
  EXPECT_TRUE(refused([](auto& c) { c.unavailable = {0, 1, 2, 3}; }));
}

TEST(Machine, draws_nothing_from_an_empty_stream) {
  const RecordedPixels nothing;
  const MachineRun run = timedRun({}, nothing);
  EXPECT_EQ(run.statistics.duration, 0);
  EXPECT_EQ(std::count(run.picture.begin(), run.picture.end(), 0),
            std::ptrdiff_t{kScreenLines} * kScreenPixels);
}

// Digest 14, row 12: the same picture in all modes, by any number of tilers and memories, with any tiler out
// of service, in either discipline, and without clocks: that of a plain z-buffer. No ties, no background.
TEST(Machine, draws_the_same_picture_in_every_configuration) {
  const RecordedPixels source = randomPixels(fewTriangles(12));
  const std::vector<std::uint8_t> expected = plainPicture(source);
  for (const HashingMode mode : kModes) {
    MachineConfiguration configuration;
    configuration.mode = mode;
    for (const QueueDiscipline discipline : {QueueDiscipline::kInputsFirst, QueueDiscipline::kQueueFirst}) {
      configuration.discipline = discipline;
      EXPECT_TRUE(timedRun(configuration, source).picture == expected) << hashingModeName(mode);
    }
    for (const int tilers : {1, 2, 4, 8}) {
      configuration.tilers = tilers;
      EXPECT_TRUE(timedRun(configuration, source).picture == expected) << tilers << " tilers";
    }
    configuration.tilers = 4;
    for (const int memories : {1, 2, 4, 8, 16}) {
      configuration.memories = memories;
      EXPECT_TRUE(timedRun(configuration, source).picture == expected) << memories << " memories";
      EXPECT_TRUE(functionalPicture(configuration, source) == expected) << memories << " memories";
    }
    configuration.memories = 8;
    for (int tiler = 0; tiler < 4; ++tiler) {
      configuration.unavailable = {tiler};
      EXPECT_TRUE(timedRun(configuration, source).picture == expected) << "without tiler " << tiler;
    }
  }
}

// Report 5.2: three of four tilers, 75 % of the speed.
TEST(Machine, takes_a_third_longer_with_three_of_four_tilers) {
  const RecordedPixels source = randomPixels({.triangles = 3000, .line_sigma = 0, .seed = 3});
  MachineConfiguration configuration;
  configuration.buffer_triangles = 4;
  const MachineRun whole = timedRun(configuration, source);
  configuration.unavailable = {2};
  const MachineRun softly = timedRun(configuration, source);
  const double ratio =
      static_cast<double>(whole.statistics.duration) / static_cast<double>(softly.statistics.duration);
  EXPECT_NEAR(ratio, 0.75, 0.01);
  EXPECT_EQ(softly.statistics.tilers[2].triangles, 0);
  EXPECT_EQ(softly.statistics.tilers[2].tiling.starved, softly.statistics.duration);
}

// Sky through BG, foreground, overlay through BG: background writes whatever is there and tilers come in any
// order, so each waits until all before is in memory.
TEST(Machine, draws_background_behind_barriers_alike_in_every_configuration) {
  RecordedPixels source;
  addBackground(source, 200);
  source.drains.push_back(source.list.size());
  const RecordedPixels foreground = randomPixels(fewTriangles(5));
  source.list.insert(source.list.end(), foreground.list.begin(), foreground.list.end());
  source.drains.push_back(source.list.size());
  RecordedPixels overlay;
  addBackground(overlay, 255);
  source.list.insert(source.list.end(), overlay.list.begin() + 100, overlay.list.begin() + 103);

  std::vector<std::uint8_t> expected = plainPicture(foreground);
  std::replace(expected.begin(), expected.end(), std::uint8_t{0}, std::uint8_t{200});
  std::fill(expected.begin() + 100 * kScreenPixels, expected.begin() + 103 * kScreenPixels,
            std::uint8_t{255});
  for (const HashingMode mode : kModes) {
    for (const int tilers : {1, 2, 4, 8}) {
      MachineConfiguration configuration;
      configuration.mode = mode;
      configuration.tilers = tilers;
      const MachineRun run = timedRun(configuration, source);
      EXPECT_TRUE(run.picture == expected) << hashingModeName(mode) << ", " << tilers << " tilers";
      EXPECT_EQ(run.statistics.barriers, 2);
      EXPECT_TRUE(functionalPicture(configuration, source) == expected);
    }
  }
  // Without barriers, as in 1983, one tiler draws triangles while another is at the sky.
  MachineConfiguration configuration;
  configuration.buffer_triangles = 400;
  configuration.barriers = false;
  const MachineRun run = timedRun(configuration, source);
  EXPECT_FALSE(run.picture == expected);
  EXPECT_EQ(run.statistics.barriers, 0);
}

// Of equal depths the first arrival stays, so a picture depends on the configuration where surfaces meet, but
// only if pixels of other colours came as near as what was there, which every run says.
TEST(Machine, pictures_differ_only_by_split_ties_and_not_at_all_with_the_brighter_rule) {
  RandomPixelOptions options = fewTriangles(9);
  options.planes = true;
  const RecordedPixels source = randomPixels(options);
  MachineConfiguration configuration;
  MemoryCounts counts;
  const std::vector<std::uint8_t> first = functionalPicture(configuration, source, &counts);
  EXPECT_GT(counts.split_ties, 20);
  EXPECT_FALSE(timedRun(configuration, source).picture == first);

  configuration.ties = TieRule::kBrighter;
  const std::vector<std::uint8_t> brighter = functionalPicture(configuration, source);
  for (const HashingMode mode : kModes) {
    configuration.mode = mode;
    for (const int tilers : {1, 4, 8}) {
      configuration.tilers = tilers;
      EXPECT_TRUE(timedRun(configuration, source).picture == brighter);
    }
  }
}

TEST(Machine, shows_the_picture_before_where_nothing_is_drawn) {
  RecordedPixels first, second;
  addBackground(first, 50);
  const RecordedPixels triangles = randomPixels(fewTriangles(6));
  Machine machine = Machine::make({}).value();
  machine.runFunctional(first);
  ASSERT_EQ(machine.readPicture()[1000], 50);
  machine.runFunctional(triangles);
  std::vector<std::uint8_t> expected = plainPicture(triangles);
  std::replace(expected.begin(), expected.end(), std::uint8_t{0}, std::uint8_t{50});
  EXPECT_TRUE(machine.readPicture() == expected);
  machine.reset();
  EXPECT_EQ(machine.readPicture()[1000], 0);
}

TEST(Machine, counts_the_same_pixels_timed_and_not) {
  const RecordedPixels source = randomPixels(fewTriangles(7));
  const MachineRun run = timedRun({}, source);
  MemoryCounts counts;
  functionalPicture({}, source, &counts);
  EXPECT_EQ(run.statistics.memoryCounts().writes(), counts.writes());
  EXPECT_EQ(run.statistics.reading, 32'768 * 240 * kNanosecond);
}

TEST(Machine, is_slowed_by_a_slow_host) {
  const RecordedPixels source = randomPixels(fewTriangles(8));
  MachineConfiguration configuration;
  configuration.host_triangle = 36'000;  // report Table 27: 36 us of pretiling a triangle
  const MachineRun run = timedRun(configuration, source);
  EXPECT_GT(run.statistics.duration, 250 * 36 * kMicrosecond);
  EXPECT_LT(run.statistics.duration, 290 * 36 * kMicrosecond);
}

// Report 2: eight words in 9.6 us at worst, which bounds oversampled small triangles more than set-up does.
TEST(Machine, is_slowed_by_slow_transfers) {
  const RecordedPixels source = randomPixels({.triangles = 400, .side = 15, .most_area = 0.1, .seed = 2});
  MachineConfiguration configuration;
  configuration.buffer_triangles = 100;
  const double set_up = static_cast<double>(timedRun(configuration, source).statistics.duration);
  EXPECT_NEAR(set_up, 100 * 8630.0 * kNanosecond, 0.02 * set_up);
  configuration.word_transfer = 1200;
  const double transfer = static_cast<double>(timedRun(configuration, source).statistics.duration);
  EXPECT_NEAR(transfer, 100 * 9600.0 * kNanosecond, 0.03 * transfer);
}

TEST(Machine, repeats_to_the_last_count) {
  const RecordedPixels source = randomPixels(fewTriangles(4));
  const MachineRun one = timedRun({}, source), other = timedRun({}, source);
  EXPECT_EQ(one.statistics.duration, other.statistics.duration);
  EXPECT_EQ(one.statistics.tree.overtaken, other.statistics.tree.overtaken);
  EXPECT_TRUE(one.picture == other.picture);
}

// No stop, no loss, all time accounted for (runTimed verifies that), whatever is too small.
TEST(Machine, conserves_pixels_and_time_on_random_loads_with_small_queues) {
  std::mt19937 random(1983);
  const auto one_of = [&random](auto... values) {
    const std::array list = {values...};
    return list[random() % list.size()];
  };
  for (unsigned trial = 0; trial < 40; ++trial) {
    RandomPixelOptions options = fewTriangles(trial);
    options.triangles = 120;
    options.line_sigma = one_of(0.0, 5.0, 80.0);
    RecordedPixels source = randomPixels(options);
    if (one_of(0, 1) == 1) source.drains = {40, 41, 100};
    MachineConfiguration configuration;
    configuration.tilers = one_of(1, 2, 4, 8, 16, 64);
    configuration.memories = one_of(1, 2, 4, 8, 16, 64);
    configuration.mode = one_of(HashingMode::kSequential, HashingMode::kInterleave, HashingMode::kScramble);
    configuration.discipline = one_of(QueueDiscipline::kInputsFirst, QueueDiscipline::kQueueFirst);
    configuration.queue_depth = one_of(0, 1, 2, 256);
    configuration.memory_fifo = one_of(1, 2, 64);
    configuration.output_fifo = one_of(1, 2, 64);
    configuration.transfer_fifo = one_of(1, 2);
    configuration.set_up_fifo = one_of(1, 5);
    configuration.buffer_triangles = one_of(1, 7, 50, 1000);
    configuration.buffers = one_of(0, 1, 2);
    configuration.host_triangle = one_of(0, 500, 5000);
    configuration.word_transfer = one_of(0, 100, 1200);
    configuration.tiler_clock_percent = one_of(25, 75, 100, 130);
    configuration.memory_design = one_of(MemoryDesign::kVariable, MemoryDesign::kFixed);
    if (configuration.tilers > 1 && one_of(0, 1) == 1) configuration.unavailable = {1, 0, 1};
    if (configuration.tilers == 2) configuration.unavailable = {1};
    const MachineRun run = timedRun(configuration, source);
    EXPECT_TRUE(run.picture == plainPicture(source)) << "trial " << trial;
    EXPECT_LE(run.statistics.tree.longestQueue(), configuration.queue_depth);
  }
}

}  // namespace
}  // namespace deltaz::ars
