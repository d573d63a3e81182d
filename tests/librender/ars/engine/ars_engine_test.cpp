// Databases on the machine, beside the reference.
#include "librender/ars/engine/ars_engine.h"

#include <cstdlib>
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <optional>
#include <string>
#include <vector>

#include "librender/ars/engine/ars_frame.h"
#include "librender/ars/engine/reference_comparison.h"
#include "librender/scenario/airport_scene.h"
#include "librender/scene/conservation.h"
#include "librender/sweep/picture_error.h"
#include "tests/librender/test_databases.h"
#include "tests/support/memory_file_system.h"

namespace deltaz {
namespace {

void expectExplained(const Database& database, const RenderOptions& options) {
  const Result<ComparedPictures> compared = compareWithReference(database, options);
  ASSERT_TRUE(compared.ok()) << compared.error().message();
  const ReferenceComparison& c = compared.value().comparison;
  const std::string found = fmt::format(
      "{} pixels: coverage {} at edges, {} not; {} other triangles, {} beside, {} in bounds, {} "
      "not; depth {} "
      "of {} not, at most {:.3f} of the bound; colour {} of {} not, {} out of range, at most "
      "{:.3f} of the bound, "
      "{:.2f}; {:.1f} dB",
      c.pixels, c.coverage_at_edges, c.coverage_unexplained, c.other_triangle, c.order_beside,
      c.order_in_bounds, c.order_unexplained, c.depth_unexplained, c.depth_compared, c.largest_depth_share,
      c.color_unexplained, c.color_compared, c.color_out_of_range, c.largest_color_share,
      c.largest_color_error, c.peak_signal_to_noise);
  SCOPED_TRACE(found);
  testing::Test::RecordProperty("found" + std::to_string(options.ars.oversample), found);
  EXPECT_EQ(c.coverage_unexplained, 0u);
  EXPECT_EQ(c.order_unexplained, 0u);
  EXPECT_EQ(c.depth_unexplained, 0u);
  EXPECT_EQ(c.color_unexplained, 0u);
  EXPECT_GT(c.depth_compared, c.pixels / 10);
  // Oversampled triangles smaller than a pixel run on beside themselves.
  EXPECT_LT(c.color_out_of_range, c.color_compared / 100);
  EXPECT_LT(c.coverage_at_edges, c.pixels / 50);
  EXPECT_GT(c.peak_signal_to_noise, 20);
}

TEST(ArsEngine, shows_what_the_reference_shows_within_its_formats) {
  const MemoryDatabase area = makeDatabase(smallArea());
  for (const bool oversample : {false, true}) {
    RenderOptions options;
    options.ars.oversample = oversample;
    options.camera = cameraOver(area.database, 0.41, 0.37, 500, 45, -25, 300, 200);
    expectExplained(area.database, options);
    options.camera = cameraOver(area.database, 0.5, 0.5, 20000, 10, -70, 200, 300);
    expectExplained(area.database, options);
    options.camera = cameraOver(area.database, 0.3, 0.6, 2, 200, -3, 256, 256);
    options.camera.roll = 15;
    expectExplained(area.database, options);
  }
}

// The sample always, more where DELTAZ_TEST_DATA names a folder with dem/.
TEST(ArsEngine, shows_real_areas_as_the_reference_does_within_its_formats) {
  std::vector<std::string> files = {std::string(DELTAZ_SAMPLES) + "/mt_rainier.tif"};
  const char* const folder = std::getenv("DELTAZ_TEST_DATA");
  if (folder != nullptr) {
    for (const char* name : {"SainteHelens.dem", "mt_everest_90m.tif"})
      files.push_back(std::string(folder) + "/dem/" + name);
  }
  // As large as the machine's screen in the soak suite.
  const int side = std::getenv("DELTAZ_VIEWS") != nullptr ? 512 : 160;
  int areas = 0;
  for (const std::string& file : files) {
    const std::optional<MemoryDatabase> area = databaseOfFile(file);
    if (!area) continue;
    ++areas;
    SCOPED_TRACE(file);
    for (const bool oversample : {false, true}) {
      RenderOptions options;
      options.ars.oversample = oversample;
      options.camera = cameraOver(area->database, 0.4, 0.3, 1500, 30, -12, side, side);
      expectExplained(area->database, options);
      options.camera = cameraOver(area->database, 0.6, 0.4, 20, 300, -4, side, side);
      expectExplained(area->database, options);
    }
  }
  EXPECT_GT(areas, 0);
}

// The report's own scene (Table 25): 21,000 triangles of terrain, 3,600 of models, 32 degrees.
TEST(ArsEngine, shows_the_reports_scene_as_the_reference_does_within_its_formats) {
  MemoryFileSystem files;
  ASSERT_TRUE(files.makeDirectory("/ars").ok());
  ASSERT_TRUE(buildAirport(files, "/ars/airport.dz").ok());
  const Result<Database> database = Database::open(files, "/ars/airport.dz");
  ASSERT_TRUE(database.ok());
  RenderOptions options;
  options.camera = airportCamera(database.value(), ars::kScreenPixels, ars::kScreenLines).value();
  for (const bool oversample : {false, true}) {
    options.ars.oversample = oversample;
    expectExplained(database.value(), options);
  }
}

RenderOptions viewOf(const Database& database, int width, int height) {
  RenderOptions options;
  options.camera = cameraOver(database, 0.41, 0.37, 500, 45, -12, width, height);
  options.tolerance = 2;
  return options;
}

// Digest section 7, 8: with background behind a barrier and no ties, how the machine is built is not seen.
TEST(ArsEngine, picture_is_the_same_however_the_machine_is_built) {
  const MemoryDatabase area = makeDatabase(smallArea());
  RenderOptions options = viewOf(area.database, 160, 120);
  options.ars = parseArsOptions("ties=brighter").value();
  const Picture expected = draw(EngineKind::kArs, area.database, options);
  for (const char* settings :
       {"timing=off", "mode=sequential", "mode=interleave", "discipline=queue-first", "tilers=1", "tilers=2",
        "tilers=8", "memories=1", "memories=32", "unavailable=2", "unavailable=0+1+3", "alternative=4",
        "queue=1", "fifo=1", "memory-fifo=1,clock=400", "buffers=1,buffer-triangles=7,word-ns=1200"}) {
    options.ars = parseArsOptions("ties=brighter," + std::string(settings)).value();
    const Picture picture = draw(EngineKind::kArs, area.database, options);
    EXPECT_EQ(picture.rgb, expected.rgb) << settings;
    EXPECT_EQ(picture.depth, expected.depth) << settings;
  }
  for (const int threads : {1, 2, 7}) {
    options.threads = threads;
    EXPECT_EQ(draw(EngineKind::kArs, area.database, options).rgb, expected.rgb);
  }
}

// A picture of several sub-images, put together, shows no joints: its pixels are those of one machine that
// sees all of it, but for the numbers' ends.
TEST(ArsEngine, draws_larger_pictures_in_sub_images) {
  const MemoryDatabase area = makeDatabase(smallArea());
  RenderOptions options = viewOf(area.database, 700, 520);
  FrameStatistics statistics;
  const Picture picture = draw(EngineKind::kArs, area.database, options, statistics);
  ASSERT_NE(statistics.ars, nullptr);
  EXPECT_EQ(statistics.ars->sub_images, 4);
  EXPECT_EQ(statistics.ars->runs.size(), 12u);
  EXPECT_GT(statistics.ars->drawing, 0);
  EXPECT_EQ(findLoss(statistics), "");
  const Picture fast = draw(EngineKind::kFast, area.database, options);
  const PictureError error = comparePictures(picture, fast);
  EXPECT_GT(error.peakSignalToNoise(), 30);
  // Along the joints it is no worse.
  double joint = 0, all = 0;
  const auto difference = [&](int i, int j) {
    const std::size_t at = 3 * (static_cast<std::size_t>(i) * 700 + static_cast<std::size_t>(j));
    double sum = 0;
    for (std::size_t c = 0; c < 3; ++c) sum += std::abs(picture.rgb[at + c] - fast.rgb[at + c]);
    return sum;
  };
  for (int i = 0; i < 510; ++i) {
    joint += difference(i, 511) + difference(i, 512);
    for (int j = 300; j < 302; ++j) all += difference(i, j);
  }
  EXPECT_LT(joint, 2 * all + 1000);
}

TEST(ArsEngine, antialiases_with_kernels_of_its_own) {
  const MemoryDatabase area = makeDatabase(smallArea());
  RenderOptions options = viewOf(area.database, 200, 150);
  RenderOptions best = options;
  best.sampling = {64, SamplePattern::kOrdered, FilterKind::kPyramid};
  const Picture judge = draw(EngineKind::kFast, area.database, best);
  const double plain = comparePictures(draw(EngineKind::kArs, area.database, options), judge).mean_square;
  options.ars = parseArsOptions("antialiaser=report,timing=off").value();
  const Picture filtered = draw(EngineKind::kArs, area.database, options);
  EXPECT_EQ(filtered.width, 200);
  EXPECT_LT(comparePictures(filtered, judge).mean_square, plain / 1.5);
}

TEST(ArsEngine, one_pass_shows_brightness) {
  const MemoryDatabase area = makeDatabase(smallArea());
  RenderOptions options = viewOf(area.database, 100, 80);
  options.ars = parseArsOptions("passes=1").value();
  const Picture gray = draw(EngineKind::kArs, area.database, options);
  for (std::size_t k = 0; k < gray.rgb.size(); k += 3) {
    ASSERT_EQ(gray.rgb[k], gray.rgb[k + 1]);
    ASSERT_EQ(gray.rgb[k], gray.rgb[k + 2]);
  }
}

TEST(ArsEngine, refuses_what_the_machine_has_no_hardware_for) {
  const MemoryDatabase area = makeDatabase(smallArea());
  FrameStatistics statistics;
  const auto refused = [&](const RenderOptions& options) {
    const Result<Picture> picture = makeEngine(EngineKind::kArs)->render(area.database, options, statistics);
    return !picture.ok() && picture.error().kind == ErrorKind::kUsage;
  };
  RenderOptions options = viewOf(area.database, 100, 80);
  options.sampling.count = 4;
  EXPECT_TRUE(refused(options));
  options = viewOf(area.database, 100, 80);
  options.lod = LodScheme::kReport;
  EXPECT_TRUE(refused(options));
  options = viewOf(area.database, 100, 80);
  options.transform = TransformKind::kDelta;
  EXPECT_TRUE(refused(options));
  options = viewOf(area.database, 100, 80);
  options.ars.machine.tilers = 3;
  EXPECT_TRUE(refused(options));
}

// What is recorded is what is drawn.
TEST(ArsEngine, records_the_stream_it_draws) {
  const MemoryDatabase area = makeDatabase(smallArea());
  const RenderOptions options = viewOf(area.database, 100, 80);
  FrameStatistics statistics;
  const Result<RecordedFrame> frame = renderAndRecord(area.database, options, statistics);
  ASSERT_TRUE(frame.ok());
  const Result<std::vector<std::byte>> bytes = ars::encodeTriangleStream(frame.value().stream);
  ASSERT_TRUE(bytes.ok()) << bytes.error().message();
  const Result<ars::TriangleStream> back = ars::decodeTriangleStream(bytes.value(), "memory");
  ASSERT_TRUE(back.ok()) << back.error().message();
  std::uint64_t triangles = 0, sent = 0;
  for (const ars::TriangleBatch& batch : back.value().batches) triangles += batch.triangles.size();
  for (const ars::FrameRun& run : statistics.ars->runs) sent += run.triangles;
  EXPECT_EQ(triangles, sent);
  EXPECT_EQ(frame.value().picture.rgb, draw(EngineKind::kArs, area.database, options, statistics).rgb);
}

// Names are taken from the timed run's samples, or without clocks from the triangles themselves.
TEST(ArsEngine, names_the_same_triangles_with_and_without_clocks) {
  const MemoryDatabase area = makeDatabase(smallArea());
  RenderOptions options = viewOf(area.database, 600, 530);  // four sub-images
  options.keep_triangle_ids = true;
  FrameStatistics timed, untimed;
  const Picture with = draw(EngineKind::kArs, area.database, options, timed);
  options.ars.timed = false;
  const Picture without = draw(EngineKind::kArs, area.database, options, untimed);
  EXPECT_EQ(with.triangle, without.triangle);
  EXPECT_EQ(with.surface, without.surface);
  EXPECT_EQ(timed.triangles.drawn, untimed.triangles.drawn);
  EXPECT_EQ(timed.triangles.no_sample, untimed.triangles.no_sample);
  EXPECT_EQ(timed.samples.tested, untimed.samples.tested);
  EXPECT_GT(timed.samples.tested, timed.samples.shaded);
  EXPECT_EQ(timed.samples.shaded, untimed.samples.shaded);
}

}  // namespace
}  // namespace deltaz
