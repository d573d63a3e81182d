// Rounding modes and flushed denormals: a host program may have set either; the contracts hold all the same.
#include <algorithm>
#include <cfenv>
#include <cmath>
#include <gtest/gtest.h>
#include <limits>
#include <ostream>

#if defined(__SSE2__)
#include <immintrin.h>
#endif

#include "libdb/access/between_posts.h"
#include "libdb/access/database.h"
#include "libdb/build/facet_error.h"
#include "libdb/build/node_bounds.h"
#include "libdb/build/pyramid.h"
#include "libdb/check/check.h"
#include "librender/objects/transform_error_bound.h"
#include "librender/scene/render.h"
#include "tests/librender/picture_comparison.h"
#include "tests/stress/bound_check.h"
#include "tests/stress/dense_sampling.h"
#include "tests/stress/stress_grids.h"
#include "tests/stress/true_positions.h"

namespace deltaz {
namespace {

struct Mode {
  std::string name;
  int rounding = FE_TONEAREST;
  bool flush = false;
};

void PrintTo(const Mode& mode, std::ostream* out) {
  *out << mode.name;
}

std::vector<Mode> modes() {
  std::vector<Mode> all = {
      {"upward", FE_UPWARD, false}, {"downward", FE_DOWNWARD, false}, {"to_zero", FE_TOWARDZERO, false}};
#if defined(__SSE2__)
  all.push_back({"denormals_flushed", FE_TONEAREST, true});
  all.push_back({"denormals_flushed_downward", FE_DOWNWARD, true});
#endif
  return all;
}

// Sets a mode for its lifetime, in this thread and in those that TBB starts for it.
class InMode {
 public:
  explicit InMode(const Mode& mode) {
    std::fegetenv(&before_);
    std::fesetround(mode.rounding);
#if defined(__SSE2__)
    // Flush to zero and denormals are zero.
    if (mode.flush) _mm_setcsr(_mm_getcsr() | 0x8040u);
#endif
  }
  ~InMode() {
    std::fesetenv(&before_);
  }
  InMode(const InMode&) = delete;
  InMode& operator=(const InMode&) = delete;

 private:
  std::fenv_t before_{};
};

class RoundingModes : public testing::TestWithParam<Mode> {};

INSTANTIATE_TEST_SUITE_P(, RoundingModes, testing::ValuesIn(modes()),
                         [](const auto& mode) { return mode.param.name; });

// A few that differ in what rounding could harm.
std::vector<NamedGrid> someGrids() {
  std::vector<NamedGrid> grids = {hills()};
  for (NamedGrid& named : extremeGrids()) {
    if (named.name == "north_pole" || named.name == "beside_the_north_pole" || named.name == "antimeridian" ||
        named.name == "least_spacing" || named.name == "scattered_voids" || named.name == "projected")
      grids.push_back(std::move(named));
  }
  return grids;
}

// A test of modes that were not set would prove nothing.
TEST_P(RoundingModes, is_in_force) {
  volatile double one = 1, three = 3, least = std::numeric_limits<double>::min();
  const double nearest = one / three;
  // Volatile too, so that no division is moved out of the mode it is meant for.
  volatile double there = 0, half = 0;
  {
    const InMode mode(GetParam());
    there = one / three;
    half = least / 2;
  }
  if (GetParam().rounding == FE_UPWARD) {
    EXPECT_GT(there, nearest);
  }
  EXPECT_EQ(half == 0, GetParam().flush);
}

TEST_P(RoundingModes, positions_keep_their_bounds_and_the_contract) {
  std::vector<NamedGrid> grids = {hills()};
  for (NamedGrid& named : extremeGrids()) {
    if (named.grid.heights.size() <= 4000) grids.push_back(std::move(named));
  }
  for (const NamedGrid& named : grids) {
    const GridGeometry geometry(named.grid.header, named.grid.patches);
    const TerrainTile tile = wholeTile(named.grid);
    const std::vector<LongVector> truth = truePositions(tile, geometry);
    for (const double above : {2.0, 1e5, 1e7}) {
      Camera camera;
      camera.eye = geometry.geodeticAt(tile.first_column + tile.columns / 2, tile.first_row + tile.rows / 2);
      camera.eye.height = geometry.metres(tile.height(tile.columns / 2, tile.rows / 2)) + above;
      camera.heading = 71;
      camera.pitch = -30;
      const ViewTransform view = makeViewTransform(camera, named.grid.header.ellipsoid);
      for (const TransformKind kind : kTransformKinds) {
        std::vector<Vector3> positions;
        double bound = 0;
        {
          const InMode mode(GetParam());
          Result<std::vector<Vector3>> result = transformPosts(kind, tile, geometry, view);
          ASSERT_TRUE(result.ok());
          positions = std::move(result).value();
          bound = transformErrorBound(kind, tile, geometry, view);
        }
        const std::string name =
            named.name + " " + std::to_string(above) + " m " + std::string(transformName(kind));
        const double observed = largestError(tile, view, positions, truth);
        expectWithin(name, observed, bound);
        if (kind == TransformKind::kExact) expectWithin(name + ", contract", observed, 1e-3);
      }
    }
  }
}

// What a build measures of its nodes in one mode.
struct Measured {
  std::vector<TileSummary> summaries;                   // by node
  std::vector<std::vector<AncestorError>> leaf_errors;  // by leaf
  std::vector<std::vector<double>> slack;               // by leaf: of its ancestors, metres
};

Measured measure(const RawGrid& grid, const GridGeometry& geometry, const PyramidPlan& plan,
                 const Mode& mode) {
  const InMode in_mode(mode);
  Measured measured;
  BetweenPosts between_posts(geometry);
  for (const PlannedNode& node : plan.nodes) {
    measured.summaries.push_back(
        summarizeTile(cutTile(grid, geometry, node.level, node.x, node.y), geometry));
    between_posts.addSteepest(node.level, node.x, node.y, measured.summaries.back().steepest);
    if (node.level == 0)
      measured.leaf_errors.push_back(leafErrors(grid, geometry, plan.level_count, node.x, node.y));
  }
  for (const PlannedNode& node : plan.nodes) {
    if (node.level != 0) continue;
    std::vector<double>& of_ancestors = measured.slack.emplace_back();
    for (int level = 1; level < plan.level_count; ++level)
      of_ancestors.push_back(between_posts.slack(level, node.x >> level, node.y >> level));
  }
  return measured;
}

// How far a valid post of a node lies outside the node's own sphere, metres.
double outsideSphere(const TerrainTile& tile, const GridGeometry& geometry, const NodeBounds& bounds) {
  const Vector3 centre{static_cast<double>(bounds.centroid[0]) * kCentroidUnit,
                       static_cast<double>(bounds.centroid[1]) * kCentroidUnit,
                       static_cast<double>(bounds.centroid[2]) * kCentroidUnit};
  const std::int64_t step = std::int64_t{1} << tile.level;
  double outside = -std::numeric_limits<double>::infinity();
  for (int j = 0; j < tile.rows; ++j) {
    for (int i = 0; i < tile.columns; ++i) {
      if (!tile.isValid(i, j)) continue;
      const Vector3 p = geometry.placeAt((tile.first_column + i) * step, (tile.first_row + j) * step)
                            .at(geometry.metres(tile.height(i, j)));
      outside = std::max(outside, length(p - centre) - static_cast<double>(bounds.radius) * kCentroidUnit);
    }
  }
  return outside;
}

// Errors and spheres measured in any mode are never too small for the usual one.
TEST_P(RoundingModes, errors_and_spheres_are_never_too_small) {
  for (const NamedGrid& named : someGrids()) {
    GridHeader header = named.grid.header;
    header.leaf_cells = named.leaf_cells;
    const GridGeometry geometry(header, named.grid.patches);
    const PyramidPlan plan = planPyramid(geometry);
    const Measured there = measure(named.grid, geometry, plan, GetParam());
    const Measured usual = measure(named.grid, geometry, plan, Mode{});
    double outside = -std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k < plan.nodes.size(); ++k) {
      const PlannedNode& node = plan.nodes[k];
      outside = std::max(outside, outsideSphere(cutTile(named.grid, geometry, node.level, node.x, node.y),
                                                geometry, there.summaries[k].bounds));
    }
    expectWithin(named.name + ": metres outside bounding spheres", outside, 0);
    double short_of = 0;
    for (std::size_t leaf = 0; leaf < usual.leaf_errors.size(); ++leaf) {
      for (std::size_t k = 0; k < usual.leaf_errors[leaf].size(); ++k) {
        const double stored = there.leaf_errors[leaf][k].maximum * kErrorUnit + there.slack[leaf][k];
        short_of = std::max(short_of, usual.leaf_errors[leaf][k].maximum * kErrorUnit - stored);
      }
    }
    expectWithin(named.name + ": metres short of the usual error", short_of, 0);
  }
}

// Whole databases, built and read in any mode: right, or refused. Text becomes numbers in the rounding mode
// of the host program, so a directed mode may refuse area.json as not canonical; it may not read a wrong
// number.
TEST_P(RoundingModes, databases_are_right_or_refused) {
  for (const NamedGrid& named : someGrids()) {
    MemoryFileSystem files;
    ASSERT_TRUE(files.makeDirectory("/folder").ok());
    const Result<BuildSummary> built = [&] {
      const InMode mode(GetParam());
      return buildTerrain(files, named.grid, kMemoryDatabasePath, {.leaf_cells = named.leaf_cells});
    }();
    if (!built.ok()) {
      std::printf("%s: refused: %s\n", named.name.c_str(), built.error().message().c_str());
      EXPECT_NE(GetParam().rounding, FE_TONEAREST) << "the usual rounding has no reason to refuse";
      EXPECT_TRUE(files.paths().empty()) << "a refused build left files";
      files = buildInMemory(named.grid, {.leaf_cells = named.leaf_cells});
    }
    const Result<Database> database = Database::open(files, kMemoryDatabasePath);
    ASSERT_TRUE(database.ok()) << database.error().message();
    const DenseSampling sampling = sampleErrors(database.value(), named.grid, 2000);
    expectWithin(named.name + ": share of stored error", sampling.share, 1);
    expectWithin(named.name + ": metres beyond the stored error", sampling.excess, 0);
    CheckOptions check;
    check.against = &named.grid;
    const Report usual = checkDatabase(files, kMemoryDatabasePath, check);
    expectWithin(named.name + ": errors found", static_cast<double>(usual.count(Severity::kError)), 0);
    const Report report = [&] {
      const InMode mode(GetParam());
      return checkDatabase(files, kMemoryDatabasePath, check);
    }();
    if (report.fatal && GetParam().rounding != FE_TONEAREST) {
      std::printf("%s: not opened: %s\n", named.name.c_str(), report.fatal->message().c_str());
      continue;
    }
    expectWithin(named.name + ": errors found in the mode",
                 static_cast<double>(report.count(Severity::kError)), 0);
    expectWithin(named.name + ": posts not compared",
                 static_cast<double>(usual.posts_compared - report.posts_compared), 0);
  }
}

TEST_P(RoundingModes, pictures_are_the_same_within_tolerance) {
  const NamedGrid named = hills();
  const MemoryFileSystem files = buildInMemory(named.grid, {.leaf_cells = named.leaf_cells});
  const Result<Database> database = Database::open(files, kMemoryDatabasePath);
  ASSERT_TRUE(database.ok());
  RenderOptions options;
  options.camera = wholeAreaCamera(database.value().area(), 160, 100, 60);
  options.tolerance = 0;
  options.keep_triangle_ids = true;
  for (const EngineKind kind : {EngineKind::kFast, EngineKind::kReference}) {
    for (const int threads : {1, 0}) {
      options.threads = threads;
      FrameStatistics statistics;
      const Result<Picture> usual = makeEngine(kind)->render(database.value(), options, statistics);
      const Result<Picture> there = [&] {
        const InMode mode(GetParam());
        return makeEngine(kind)->render(database.value(), options, statistics);
      }();
      ASSERT_TRUE(usual.ok() && there.ok());
      const PictureDifference difference =
          comparePictures(database.value(), options.camera, there.value(), usual.value());
      const std::string name = std::string(kind == EngineKind::kFast ? "fast" : "reference") +
                               (threads == 1 ? ", one thread" : ", all threads");
      expectWithin(name + ": differing pixels", static_cast<double>(difference.differing),
                   0.001 * static_cast<double>(difference.pixels));
      expectWithin(name + ": pixels from an edge", difference.farthest_from_edge, 1.0 / 256);
      expectWithin(name + ": relative depth", difference.largest_depth_difference, 1e-3);
    }
  }
}

}  // namespace
}  // namespace deltaz
