#include "librender/scene/conservation.h"

#include <gtest/gtest.h>

#include "tests/librender/cut_checks.h"
#include "tests/librender/test_databases.h"
#include "tests/support/furnished_area.h"

namespace deltaz {
namespace {

TEST(Conservation, finds_what_does_not_add_up) {
  FrameStatistics statistics;
  EXPECT_EQ(findLoss(statistics), "");
  statistics.nodes = {28, 1, 2, 3, 4, 5, 6, 7};
  statistics.models = {4, 1, 1, 2};
  statistics.triangles = {10, 1, 2, 3, 4};
  statistics.samples = {9, 9, 9};
  EXPECT_EQ(findLoss(statistics), "");
  FrameStatistics one = statistics;
  ++one.nodes.opened;
  EXPECT_EQ(findLoss(one), "nodes: 28 came in, 29 were accounted for");
  one = statistics;
  --one.models.drawn;
  EXPECT_EQ(findLoss(one), "models: 4 came in, 3 were accounted for");
  one = statistics;
  ++one.triangles.in;
  EXPECT_EQ(findLoss(one), "triangles: 11 came in, 10 were accounted for");
  one = statistics;
  ++one.samples.written;
  EXPECT_EQ(findLoss(one), "samples: 10 were written of 9 tested");
}

// Views of all sorts; `seen` counts those in which each way of a node or a triangle to go was met.
struct Ways {
  int opened = 0, out_of_view = 0, back_facing = 0, clipped = 0, no_sample = 0, drawn = 0;
};

void expectConserved(const Database& database, int views, Ways& ways) {
  std::mt19937 random(25);
  for (int view = 0; view < views; ++view) {
    RenderOptions options;
    options.camera = randomView(database, random, 96, 64);
    for (const double tolerance : {0.0, 1.0, 20.0}) {
      options.tolerance = tolerance;
      for (const LodScheme lod : {LodScheme::kError, LodScheme::kReport}) {
        options.lod = lod;
        FrameStatistics s;
        draw(EngineKind::kFast, database, options, s);
        EXPECT_EQ(findLoss(s), "") << inWords(options.camera) << " tolerance " << tolerance;
        ways.opened += s.nodes.opened > 0 ? 1 : 0;
        ways.out_of_view += s.nodes.out_of_view > 0 ? 1 : 0;
        ways.back_facing += s.triangles.back_facing > 0 ? 1 : 0;
        ways.clipped += s.triangles.clipped > 0 ? 1 : 0;
        ways.no_sample += s.triangles.no_sample > 0 ? 1 : 0;
        ways.drawn += s.triangles.drawn > 0 ? 1 : 0;
      }
    }
  }
}

TEST(Conservation, holds_in_every_view_of_areas_with_voids_and_models) {
  Ways ways;
  SyntheticGridOptions options = smallArea();
  for (const VoidPattern voids : {VoidPattern::kNone, VoidPattern::kScattered, VoidPattern::kWestHalf}) {
    options.voids = voids;
    expectConserved(makeDatabase(options).database, viewsPerArea(15), ways);
  }
  const Result<Database> furnished = Database::open(furnishedArea(), kMemoryDatabasePath);
  ASSERT_TRUE(furnished.ok());
  expectConserved(furnished.value(), viewsPerArea(15), ways);
  for (const int way :
       {ways.opened, ways.out_of_view, ways.back_facing, ways.clipped, ways.no_sample, ways.drawn})
    EXPECT_GT(way, 10);
}

TEST(Conservation, holds_for_the_reference) {
  const Result<Database> area = Database::open(furnishedArea(), kMemoryDatabasePath);
  ASSERT_TRUE(area.ok());
  std::mt19937 random(7);
  for (int view = 0; view < 5; ++view) {
    RenderOptions options;
    options.camera = randomView(area.value(), random, 48, 32);
    FrameStatistics statistics;
    draw(EngineKind::kReference, area.value(), options, statistics);
    EXPECT_EQ(findLoss(statistics), "") << inWords(options.camera);
  }
}

}  // namespace
}  // namespace deltaz
