// Stored geometric errors against dense samples of the full-resolution surface: points of its facets, at
// random all over an area, never lie farther from any coarser level than the node over them says.
//
// The default takes 100 000 points an area; DELTAZ_SOAK_POINTS asks for another number (scripts/soak.sh: 25
// million). Distances are SurfaceProbe's, not the builder's. Prints for each level the least room there was.
#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstdlib>
#include <gtest/gtest.h>
#include <memory>
#include <optional>
#include <random>
#include <string>
#include <tbb/parallel_for.h>
#include <vector>

#include "libdb/access/database.h"
#include "libdb/check/surface_probe.h"
#include "libdb/source/elevation_source.h"
#include "tests/support/projected_grid.h"
#include "tests/support/synthetic_grid.h"

namespace deltaz {
namespace {

std::size_t pointsAsked() {
  constexpr std::size_t kDefault = 100000;
  const char* const text = std::getenv("DELTAZ_SOAK_POINTS");
  return text == nullptr ? kDefault : static_cast<std::size_t>(std::max(1L, std::atol(text)));
}

FullGrid fullGridOf(const RawGrid& grid) {
  FullGrid full;
  full.columns = {grid.header.x_axis.first, grid.header.x_axis.first + grid.header.x_axis.count};
  full.rows = {grid.header.y_axis.first, grid.header.y_axis.first + grid.header.y_axis.count};
  full.heights = grid.heights;
  full.valid = grid.valid;
  if (full.valid.empty()) full.valid.assign(full.heights.size(), 1);
  return full;
}

// What was seen of one level: the stored error and the largest distance of the node with least room,
// relative.
struct Seen {
  std::uint64_t samples = 0;
  double stored = 0, observed = 0;
  void add(double error, double most) {
    ++samples;
    if (error * stored > observed * most || stored == 0) {
      stored = most;
      observed = error;
    }
  }
  void merge(const Seen& other) {
    samples += other.samples;
    if (other.stored > 0 && (stored == 0 || other.observed * stored > observed * other.stored)) {
      stored = other.stored;
      observed = other.observed;
    }
  }
};

class Sampler {
 public:
  Sampler(const RawGrid& grid, const Database& database)
      : full_(fullGridOf(grid)), geometry_(database.grid(0)), levels_(geometry_.header().level_count) {
    for (int level = 0; level < levels_; ++level) nodes_.push_back(nodesOfLevel(database, 0, level).value());
  }

  // Samples are spread evenly over the leaves; `seen` is indexed by level.
  std::vector<Seen> run(std::size_t points) {
    std::vector<std::vector<Seen>> parts(nodes_[0].size(),
                                         std::vector<Seen>(static_cast<std::size_t>(levels_)));
    const std::size_t each = points / nodes_[0].size() + 1;
    tbb::parallel_for(std::size_t{0}, nodes_[0].size(),
                      [&](std::size_t leaf) { sampleLeaf(nodes_[0][leaf].record, each, parts[leaf]); });
    std::vector<Seen> seen(static_cast<std::size_t>(levels_));
    for (const auto& part : parts) {
      for (std::size_t level = 0; level < part.size(); ++level) seen[level].merge(part[level]);
    }
    return seen;
  }
  std::uint64_t exceeded() const { return exceeded_; }

 private:
  double storedOver(const NodeRecord& leaf, int level) const {
    for (const Node& node : nodes_[static_cast<std::size_t>(level)]) {
      if (node.record.x == leaf.x >> level && node.record.y == leaf.y >> level) return node.geometricError();
    }
    return -1;
  }

  void sampleLeaf(const NodeRecord& leaf, std::size_t points, std::vector<Seen>& seen) {
    const PostRange columns = extentColumns(geometry_, leaf), rows = extentRows(geometry_, leaf);
    const SurfaceProbe fine(full_, geometry_, 0, columns, rows);
    std::vector<SurfaceProbe> coarse;
    std::vector<double> stored;
    for (int level = 1; level < levels_; ++level) {
      coarse.emplace_back(full_, geometry_, level, columns, rows);
      stored.push_back(storedOver(leaf, level));
    }
    std::mt19937_64 random(static_cast<std::uint64_t>(leaf.x) * 0x9E3779B97F4A7C15u +
                           static_cast<std::uint32_t>(leaf.y));
    const auto number = [&] { return static_cast<double>(random() >> 11) * 0x1p-53; };
    const EllipsoidShape& ellipsoid = geometry_.header().ellipsoid;
    for (std::size_t point = 0; point < points; ++point) {
      const double x =
          static_cast<double>(columns.begin) + number() * static_cast<double>(columns.size() - 1);
      const double y = static_cast<double>(rows.begin) + number() * static_cast<double>(rows.size() - 1);
      const auto column = static_cast<std::int64_t>(std::floor(x)),
                 row = static_cast<std::int64_t>(std::floor(y));
      const double a = x - std::floor(x), b = y - std::floor(y);
      const bool top = b > a;
      if (!fine.isDrawn(column, row, top)) continue;
      const Vector3& sw = fine.position(column, row);
      const Vector3& ne = fine.position(column + 1, row + 1);
      const Vector3& third = top ? fine.position(column, row + 1) : fine.position(column + 1, row);
      const GeodeticPoint place = toGeodetic(
          ellipsoid, top ? sw * (1 - b) + third * (b - a) + ne * a : sw * (1 - a) + third * (a - b) + ne * b);
      const RowConstants of_row = rowConstants(ellipsoid, place.latitude);
      const ColumnConstants of_column = columnConstants(place.longitude);
      const Vector3 foot = earthCentred(of_row, of_column, 0), up = upVector(of_row, of_column);
      for (std::size_t k = 0; k < coarse.size(); ++k) {
        const auto height = coarse[k].heightOver(x, y, foot, up);
        if (!height) continue;
        const double error = std::abs(*height - place.height);
        if (!(error <= stored[k])) ++exceeded_;
        if (std::isfinite(stored[k])) seen[k + 1].add(error, stored[k]);
      }
    }
  }

  const FullGrid full_;
  const GridGeometry& geometry_;
  int levels_;
  std::vector<std::vector<Node>> nodes_;
  std::atomic<std::uint64_t> exceeded_ = 0;
};

// `least_share` is how much of the stored error must be seen, for a bound far off says nothing.
void expectNeverExceeded(const std::string& name, const RawGrid& grid, double least_share = 0.5) {
  const MemoryFileSystem files = buildInMemory(grid);
  Result<Database> database = Database::open(files, kMemoryDatabasePath);
  ASSERT_TRUE(database.ok()) << database.error().message();
  Sampler sampler(grid, database.value());
  const std::vector<Seen> seen = sampler.run(pointsAsked());
  for (std::size_t level = 1; level < seen.size(); ++level) {
    std::printf("%-14s level %zu: %9llu samples; nearest: stored %10.4f m, observed %10.4f m (%.4f)\n",
                name.c_str(), level, static_cast<unsigned long long>(seen[level].samples), seen[level].stored,
                seen[level].observed, seen[level].observed / seen[level].stored);
    EXPECT_GT(seen[level].samples, 0u);
    EXPECT_GT(seen[level].observed, least_share * seen[level].stored);
  }
  EXPECT_EQ(sampler.exceeded(), 0u);
}

class SyntheticAt : public testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(, SyntheticAt, testing::Values(0, 60, 85));

TEST_P(SyntheticAt, no_dense_sample_exceeds_a_stored_error) {
  SyntheticGridOptions options;
  options.south = GetParam();
  options.west = 8;
  options.spacing_latitude = options.spacing_longitude = {3, 1};
  options.columns = options.rows = 600;
  options.voids = VoidPattern::kHole;
  expectNeverExceeded("latitude " + std::to_string(GetParam()), syntheticGrid(options));
}

TEST(DenseSamples, beside_and_on_a_pole_exceed_no_stored_error) {
  SyntheticGridOptions options;
  options.south = 85;
  options.spacing_latitude = {60, 1};
  options.spacing_longitude = {300, 1};
  options.columns = options.rows = 301;
  // Slivers of 2 m beside the pole are steep, and steep facets have much room between posts.
  expectNeverExceeded("to the pole", syntheticGrid(options), 0.25);
}

TEST(DenseSamples, of_a_projected_grid_exceed_no_stored_error) {
  expectNeverExceeded("UTM",
                      projectedGrid({.easting = 250000, .northing = 7000000, .columns = 500, .rows = 400}));
}

// The sample always; the others where a folder of real files is named, and then all of them.
TEST(RealFiles, no_dense_sample_exceeds_a_stored_error) {
  std::vector<std::string> paths = {DELTAZ_SAMPLES "/mt_rainier.tif"};
  if (const char* const folder = std::getenv("DELTAZ_TEST_DATA"); folder != nullptr && *folder != '\0') {
    for (const char* const name : {"mt_everest_90m.tif", "N48W125.hgt.zip/N48W125.hgt", "SainteHelens.dem"}) {
      const std::string path = std::string(folder) + "/dem/" + name;
      paths.push_back(path.find(".zip/") == std::string::npos ? path : "/vsizip/" + path);
    }
  }
  for (const std::string& path : paths) {
    const Result<RawGrid> grid = readElevationSource(path, {});
    ASSERT_TRUE(grid.ok()) << grid.error().message();
    const std::string name = path.substr(path.rfind('/') + 1);
    std::printf("real file: %s\n", name.c_str());
    expectNeverExceeded(name.substr(0, name.find('.')), grid.value());
  }
}

}  // namespace
}  // namespace deltaz
