#include "librender/frame_drawer.h"

#include <functional>
#include <gtest/gtest.h>
#include <limits>

#include "librender/raster/resolver.h"
#include "librender/scene/arena.h"
#include "librender/scene/texture_cache.h"
#include "librender/scene/texture_store.h"
#include "tests/librender/test_databases.h"

namespace deltaz {
namespace {

struct Drawn {
  Picture picture;
  FrameStatistics statistics;
};

// Terrain alone, of a scheduler to which `before` has been done.
Drawn drawTerrain(const Database& database, const RenderOptions& options,
                  const std::function<void(Scheduler&)>& before) {
  Drawn drawn;
  TextureCache cache;
  FrameScratch scratch;
  Stopwatch watch;
  Result<Picture> picture = drawOnThreads(2, [&]() -> Result<Picture> {
    DELTAZ_TRY_ASSIGN(const Environment environment, makeEnvironment(database, options));
    const SeamIndex seams(database);
    FrameDrawer drawer(database, seams, environment, options, scratch, drawn.statistics, watch);
    Scheduler scheduler(database, seams, environment.view, {.tolerance = options.tolerance},
                        drawn.statistics.nodes);
    before(scheduler);
    DELTAZ_TRY(drawer.drawTerrain(scheduler, HiddenNodes::kNotOpened));
    const TiledFrame& frame = drawer.settle();
    Picture resolved = makePicture(options);
    TextureStore textures(environment.color_map, &cache);
    resolve(environment, frame, drawer.nodes(), textures, resolved);
    return resolved;
  });
  if (!picture.ok()) throw std::runtime_error(picture.error().message());
  drawn.picture = std::move(picture).value();
  return drawn;
}

// What was drawn must be made finer: nodes called drawn that nobody drew stand for it, and show only if all
// is drawn anew.
TEST(FrameDrawer, draws_anew_what_turns_out_too_coarse) {
  const MemoryDatabase memory = makeDatabaseOf(countryOfTwoErrors(24), 8);
  RenderOptions options;
  options.camera = {{45.0, -121.947, 3000}, 0, -1.6, 0, 3, 384, 192};
  const ViewTransform view = makeViewTransform(options.camera, EllipsoidShape{});
  const SeamIndex seams(memory.database);
  const Drawn expected = drawTerrain(memory.database, options, [](Scheduler&) {});
  int drawn_anew = 0;
  for (double farthest = 180000; farthest < 240000 && drawn_anew < 3; farthest += 500) {
    const auto call_drawn = [&](Scheduler& scheduler) {
      ASSERT_TRUE(scheduler.advance(farthest, {}).ok());
      std::vector<std::uint32_t> all(scheduler.cut().size());
      for (std::uint32_t k = 0; k < all.size(); ++k) all[k] = k;
      scheduler.setDrawn(all);
    };
    FrameStatistics::Nodes counts;
    Scheduler twin(memory.database, seams, view, {}, counts);
    call_drawn(twin);
    if (twin.complete()) continue;
    ASSERT_TRUE(twin.advance(std::numeric_limits<double>::infinity(), {}).ok());
    if (!twin.contradicted()) continue;
    ++drawn_anew;
    const Drawn found = drawTerrain(memory.database, options, call_drawn);
    EXPECT_TRUE(found.picture.rgb == expected.picture.rgb) << farthest;
    EXPECT_TRUE(found.picture.depth == expected.picture.depth) << farthest;
    EXPECT_EQ(found.statistics.nodes.drawn, expected.statistics.nodes.drawn);
    EXPECT_EQ(found.statistics.triangles.in, expected.statistics.triangles.in);
  }
  EXPECT_GT(drawn_anew, 0);
}

}  // namespace
}  // namespace deltaz
