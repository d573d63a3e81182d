// Grids that overlap or touch are drawn as one ground.
#include <cstdio>
#include <gtest/gtest.h>
#include <stdexcept>
#include <tbb/parallel_for.h>

#include "libdb/build/build_terrain.h"
#include "tests/librender/cut_checks.h"
#include "tests/librender/picture_comparison.h"
#include "tests/librender/test_databases.h"
#include "tests/support/projected_grid.h"

namespace deltaz {
namespace {

struct SeamCase {
  const char* name;
  std::vector<RawGrid> grids;  // the one on top first
};

// The coarse country every case lies in: 121 x 121 posts of 3 arc-seconds from 46.8 N, 121.8 W.
SyntheticGridOptions coarse() {
  return smallArea();
}

SyntheticGridOptions fine(double south, double west, std::int64_t columns, std::int64_t rows,
                          Rational spacing) {
  SyntheticGridOptions options = smallArea();
  options.seed = 2;
  options.south = south;
  options.west = west;
  options.spacing_latitude = options.spacing_longitude = spacing;
  options.columns = columns;
  options.rows = rows;
  return options;
}

std::vector<SeamCase> cases() {
  std::vector<SeamCase> result;
  const RawGrid country = syntheticGrid(coarse());
  // On the coarse posts: 1 arc-second, from 36 to 84 coarse posts.
  result.push_back({"aligned inset", {syntheticGrid(fine(46.83, -121.77, 145, 121, {1, 1})), country}});
  // Between them, with another spacing.
  result.push_back(
      {"inset between the posts",
       {syntheticGrid(fine(46.8 + 100.5 / 3600, -121.8 + 95.25 / 3600, 150, 131, {4, 5})), country}});
  SyntheticGridOptions holed = fine(46.83, -121.77, 145, 121, {1, 1});
  holed.voids = VoidPattern::kHole;
  result.push_back({"inset with a hole", {syntheticGrid(holed), country}});
  SyntheticGridOptions scattered = fine(46.83 + 0.4 / 3600, -121.77, 100, 90, {1, 1});
  scattered.voids = VoidPattern::kScattered;
  result.push_back({"inset with scattered voids", {syntheticGrid(scattered), country}});
  SyntheticGridOptions void_country = coarse();
  void_country.voids = VoidPattern::kScattered;
  result.push_back({"inset over voids",
                    {syntheticGrid(fine(46.83, -121.77, 145, 121, {1, 1})), syntheticGrid(void_country)}});
  // Two zones that share the parallel 46.9 N, 2 and 3 arc-seconds.
  result.push_back({"zones side by side", {syntheticGrid(fine(46.9, -121.8, 181, 91, {2, 1})), country}});
  // Over the country's north-eastern corner and beyond.
  result.push_back({"inset across the end",
                    {syntheticGrid(fine(46.86 + 0.3 / 3600, -121.75, 300, 250, {1, 1})), country}});
  // Over all of it: nothing of the country is drawn, but along the ends the inset stands on its posts.
  result.push_back({"inset over everything", {syntheticGrid(fine(46.8, -121.8, 121, 121, {3, 1})), country}});
  ProjectedGridOptions utm;
  utm.columns = 131;
  utm.rows = 113;
  utm.spacing = 20;
  utm.zone = 10;
  utm.easting = 593000;
  utm.northing = 5188000;
  result.push_back({"projected inset", {projectedGrid(utm), country}});
  return result;
}

MemoryDatabase build(const std::vector<RawGrid>& grids, int leaf_cells) {
  BuildOptions options;
  options.leaf_cells = leaf_cells;
  MemoryFileSystem files;
  (void)files.makeDirectory("/folder");
  const Result<BuildSummary> built = buildTerrain(files, grids, kMemoryDatabasePath, options);
  if (!built.ok()) throw std::runtime_error(built.error().message());
  Result<Database> database = Database::open(files, kMemoryDatabasePath);
  if (!database.ok()) throw std::runtime_error(database.error().message());
  return {std::move(files), std::move(database).value()};
}

TEST(Seams, no_view_has_a_crack_between_two_grids) {
  for (const SeamCase& area : cases()) {
    const MemoryDatabase memory = build(area.grids, 16);
    ASSERT_EQ(memory.database.seams().size(), 1u) << area.name;
    const Seam& seam = memory.database.seams().front();
    std::printf("%s: %zu vertices, %zu faces, %zu runs, error %.2f m\n", area.name, seam.vertices.size(),
                seam.faces.size(), seam.runs.size(), seam.error);
    const SeamIndex index(memory.database);
    std::vector<std::string> cracks(static_cast<std::size_t>(viewsPerArea(5)));
    tbb::parallel_for(std::size_t{0}, cracks.size(), [&](std::size_t n) {
      std::mt19937 random(static_cast<std::uint32_t>(n));
      const ViewTransform view =
          makeViewTransform(randomView(memory.database, random, 256, 192), EllipsoidShape{});
      FrameStatistics::Nodes counts;
      const Schedule schedule = scheduleNodes(memory.database, index, view, {}, counts).value();
      cracks[n] = findSeamCrack(memory.database, meshOfCut(memory.database, schedule, view));
    });
    for (std::size_t n = 0; n < cracks.size(); ++n) ASSERT_EQ(cracks[n], "") << area.name << ", view " << n;
  }
}

// What the checker must find.
TEST(Seams, a_missing_face_and_an_undrawn_node_are_found) {
  const SeamCase area = cases().front();
  const MemoryDatabase memory = build(area.grids, 16);
  const Camera camera = cameraOver(memory.database, 0.2, 0.2, 400, 45, -10, 256, 192);
  const ViewTransform view = makeViewTransform(camera, EllipsoidShape{});
  FrameStatistics::Nodes counts;
  const Schedule schedule =
      scheduleNodes(memory.database, SeamIndex(memory.database), view, {}, counts).value();
  const CutMesh mesh = meshOfCut(memory.database, schedule, view);
  ASSERT_EQ(findSeamCrack(memory.database, mesh), "");
  std::size_t tried = 0;
  for (std::size_t n = 0; n < mesh.nodes.size(); ++n) {
    if (mesh.nodes[n].seam_vertices.empty()) continue;
    ++tried;
    CutMesh holed = mesh;
    holed.nodes[n].faces.pop_back();  // one of the seam's
    EXPECT_NE(findSeamCrack(memory.database, holed), "");
    CutMesh unseamed = mesh;
    unseamed.nodes[n].faces.clear();
    EXPECT_NE(findSeamCrack(memory.database, unseamed), "");
    if (tried == 3) break;
  }
  EXPECT_EQ(tried, 3u);
}

TEST(Seams, engines_agree_and_nothing_shows_through) {
  for (const SeamCase& area : cases()) {
    const MemoryDatabase memory = build(area.grids, 16);
    std::mt19937 random(17);
    int differing = 0, pixels = 0;
    for (int n = 0; n < viewsPerArea(2); ++n) {
      RenderOptions options;
      options.camera = randomView(memory.database, random, 200, 150);
      options.tolerance = 0;
      const Picture fast = draw(EngineKind::kFast, memory.database, options);
      const Picture reference = draw(EngineKind::kReference, memory.database, options);
      int of_view = 0;
      for (std::size_t pixel = 0; pixel < fast.surface.size(); ++pixel)
        of_view += fast.surface[pixel] != reference.surface[pixel] ? 1 : 0;
      if (of_view * 100 > static_cast<int>(fast.surface.size())) {
        std::printf("%s, view %d: %d pixels; %s\n", area.name, n, of_view, inWords(options.camera).c_str());
      }
      differing += of_view;
      pixels += static_cast<int>(fast.surface.size());
    }
    EXPECT_LE(differing, pixels / 1000) << area.name;
  }
}

// The seam of these grids hangs hundreds of metres below the posts of the leaves that draw it; a narrow view
// of nothing else once took those leaves for out of view.
TEST(Seams, are_drawn_where_they_leave_the_posts_of_their_leaves) {
  for (const SeamCase& area : cases()) {
    if (std::string(area.name) != "inset across the end") continue;
    const MemoryDatabase memory = build(area.grids, 16);
    RenderOptions options;
    options.camera.eye = {46.869891607, -121.705374463, 2055.5512};
    options.camera.heading = 173.8277;
    options.camera.pitch = 12.4973;
    options.camera.field_of_view = 7.1869;
    options.camera.width = 200;
    options.camera.height = 150;
    const Picture fast = draw(EngineKind::kFast, memory.database, options);
    for (const Surface surface : fast.surface) ASSERT_EQ(surface, Surface::kTerrain);
  }
}

}  // namespace
}  // namespace deltaz
