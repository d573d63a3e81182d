#include "tests/stress/promises.h"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <limits>

#include "libdb/access/database.h"
#include "libdb/access/ground_query.h"
#include "libdb/check/check.h"
#include "tests/stress/bound_check.h"
#include "tests/stress/dense_sampling.h"

namespace deltaz {
namespace {

constexpr int kSamples = 4000;

std::string issuesOf(const Report& report) {
  std::string text;
  for (const IssueGroup& group : report.groups) {
    for (const Issue& issue : group.first) text += issue.message + "\n";
  }
  if (report.fatal) text += report.fatal->message();
  return text;
}

// How many posts of the leaves differ from the source, in height or in being void.
double changedPosts(const Database& database, const RawGrid& grid) {
  const Result<std::vector<Node>> nodes = nodesOfLevel(database, 0, 0);
  if (!nodes.ok()) return std::numeric_limits<double>::infinity();
  double changed = 0;
  for (const Node& node : nodes.value()) {
    const Result<TerrainTile> tile = database.terrain(node);
    if (!tile.ok()) return std::numeric_limits<double>::infinity();
    const TerrainTile& t = tile.value();
    for (int j = 0; j < t.rows; ++j) {
      for (int i = 0; i < t.columns; ++i) {
        const std::int64_t column = t.first_column + i - grid.header.x_axis.first;
        const std::int64_t row = t.first_row + j - grid.header.y_axis.first;
        const bool valid = grid.isValid(column, row);
        if (t.isValid(i, j) != valid || (valid && t.height(i, j) != grid.height(column, row))) ++changed;
      }
    }
  }
  return changed;
}

// How far a valid post lies outside its node's sphere, metres; negative if all are inside.
double outsideSpheres(const Database& database) {
  double outside = -std::numeric_limits<double>::infinity();
  const GridGeometry& geometry = database.grid(0);
  for (int level = 0; level < geometry.header().level_count; ++level) {
    const Result<std::vector<Node>> nodes = nodesOfLevel(database, 0, level);
    if (!nodes.ok()) return std::numeric_limits<double>::infinity();
    const std::int64_t step = std::int64_t{1} << level;
    for (const Node& node : nodes.value()) {
      if (node.record.isEmpty()) continue;
      const Result<TerrainTile> tile = database.terrain(node);
      if (!tile.ok()) return std::numeric_limits<double>::infinity();
      const TerrainTile& t = tile.value();
      for (int j = 0; j < t.rows; ++j) {
        for (int i = 0; i < t.columns; ++i) {
          if (!t.isValid(i, j)) continue;
          const Vector3 p = geometry.placeAt((t.first_column + i) * step, (t.first_row + j) * step)
                                .at(geometry.metres(t.height(i, j)));
          outside = std::max(outside, length(p - node.centroid) - node.radius());
        }
      }
    }
  }
  return outside;
}

// The largest difference between a post's height and the ground asked for at its place, metres.
double groundError(const Database& database, const RawGrid& grid) {
  const GridGeometry& geometry = database.grid(0);
  const std::int64_t columns = grid.header.x_axis.count, rows = grid.header.y_axis.count;
  double largest = 0;
  for (std::int64_t row = 0; row < rows; row += std::max<std::int64_t>(1, rows / 10)) {
    for (std::int64_t column = 0; column < columns; column += std::max<std::int64_t>(1, columns / 10)) {
      if (!grid.isValid(column, row)) continue;
      const GeodeticPoint place =
          geometry.geodeticAt(grid.header.x_axis.first + column, grid.header.y_axis.first + row);
      const Result<std::optional<double>> ground = groundHeight(database, place.latitude, place.longitude);
      if (!ground.ok()) return std::numeric_limits<double>::infinity();
      // Beside voids a post may have no facet, and so no ground.
      if (ground.value())
        largest = std::max(largest, std::abs(*ground.value() - geometry.metres(grid.height(column, row))));
    }
  }
  return largest;
}

}  // namespace

void holdToPromises(const NamedGrid& named, const MemoryFileSystem& files) {
  Result<Database> opened = Database::open(files, kMemoryDatabasePath);
  ASSERT_TRUE(opened.ok()) << opened.error().message();
  const Database& database = opened.value();
  expectWithin(named.name + ": posts changed", changedPosts(database, named.grid), 0);

  CheckOptions check;
  check.against = &named.grid;
  check.against_name = named.name;
  const Report report = checkDatabase(files, kMemoryDatabasePath, check);
  EXPECT_TRUE(report.complete) << issuesOf(report);
  expectWithin(named.name + ": errors found by the check",
               static_cast<double>(report.count(Severity::kError)), 0);
  if (report.count(Severity::kError) > 0) ADD_FAILURE() << issuesOf(report);

  expectWithin(named.name + ": metres outside bounding spheres", outsideSpheres(database), 0);
  expectWithin(named.name + ": metres between a post and the ground there", groundError(database, named.grid),
               1e-3);
  const DenseSampling sampling = sampleErrors(database, named.grid, kSamples);
  EXPECT_TRUE(sampling.samples > 0 || sampling.known == 0) << "nothing was sampled";
  expectWithin(named.name + ": share of stored error, " + std::to_string(sampling.samples) + " samples",
               sampling.share, 1);
  expectWithin(named.name + ": metres beyond the stored error", sampling.excess, 0);
}

void buildOrRefuse(const NamedGrid& named) {
  MemoryFileSystem files;
  ASSERT_TRUE(files.makeDirectory("/folder").ok());
  const Result<BuildSummary> built =
      buildTerrain(files, named.grid, kMemoryDatabasePath, {.leaf_cells = named.leaf_cells});
  if (!built.ok()) {
    std::printf("%s: refused: %s\n", named.name.c_str(), built.error().message().c_str());
    EXPECT_EQ(built.error().kind, ErrorKind::kInvalid) << built.error().message();
    EXPECT_TRUE(files.paths().empty()) << "a refused build left files";
    return;
  }
  holdToPromises(named, files);
}

}  // namespace deltaz
