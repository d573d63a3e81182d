// The stored error against the surfaces themselves: dense sampling of the full-resolution facets never finds
// more.
#include "libdb/build/facet_error.h"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <optional>
#include <random>

#include "libdb/access/database.h"
#include "libdb/build/pyramid.h"
#include "tests/support/synthetic_grid.h"

namespace deltaz {
namespace {

// Where the line through `foot` along `up` meets the surface of one level, by trying every facet near
// `column`, `row` (in posts of that level): slow, and independent of how the builder walks.
std::optional<double> surfaceHeight(const RawGrid& grid, const GridGeometry& geometry, int level,
                                    double column, double row, const Vector3& foot, const Vector3& up) {
  const std::int64_t step = std::int64_t{1} << level;
  const auto at = [&](std::int64_t i, std::int64_t j) -> std::optional<Vector3> {
    const std::int64_t c = i * step - grid.header.x_axis.first, r = j * step - grid.header.y_axis.first;
    if (c < 0 || c >= grid.header.x_axis.count || r < 0 || r >= grid.header.y_axis.count ||
        !grid.isValid(c, r))
      return std::nullopt;
    return toEarthCentred(grid.header.ellipsoid, {geometry.latitude(j * step), geometry.longitude(i * step),
                                                  geometry.metres(grid.height(c, r))});
  };
  const auto tryFacet = [&](std::optional<Vector3> a, std::optional<Vector3> b,
                            std::optional<Vector3> c) -> std::optional<double> {
    if (!a || !b || !c) return std::nullopt;
    // Inside if the line passes all three edges on the same side.
    const double s0 = dot(up, cross(*a - foot, *b - foot)), s1 = dot(up, cross(*b - foot, *c - foot)),
                 s2 = dot(up, cross(*c - foot, *a - foot));
    const double slack = 1e-9 * (std::abs(s0) + std::abs(s1) + std::abs(s2));
    if (!(s0 >= -slack && s1 >= -slack && s2 >= -slack)) return std::nullopt;
    const Vector3 normal = cross(*b - *a, *c - *a);
    return dot(*a - foot, normal) / dot(up, normal);
  };
  const auto I0 = static_cast<std::int64_t>(std::floor(column)),
             J0 = static_cast<std::int64_t>(std::floor(row));
  for (std::int64_t J = J0 - 1; J <= J0 + 1; ++J) {
    for (std::int64_t I = I0 - 1; I <= I0 + 1; ++I) {
      if (const auto h = tryFacet(at(I, J), at(I + 1, J), at(I + 1, J + 1))) return h;
      if (const auto h = tryFacet(at(I, J), at(I + 1, J + 1), at(I, J + 1))) return h;
    }
  }
  return std::nullopt;
}

struct Place {
  const char* name;
  double south;
  double west;
  Rational spacing;
  VoidPattern voids;
};

class FacetErrorAt : public testing::TestWithParam<Place> {};

INSTANTIATE_TEST_SUITE_P(, FacetErrorAt,
                         testing::Values(Place{"equator", -0.5, 10, {30, 1}, VoidPattern::kNone},
                                         Place{"latitude_60", 60, 179.6, {30, 1}, VoidPattern::kNone},
                                         Place{"latitude_85", 85, -30, {30, 1}, VoidPattern::kHole},
                                         Place{"wide_cells", 45, 0, {600, 1}, VoidPattern::kNone}),
                         [](const auto& place) { return std::string(place.param.name); });

TEST_P(FacetErrorAt, dense_sampling_never_exceeds_the_stored_error) {
  SyntheticGridOptions options;
  options.south = GetParam().south;
  options.west = GetParam().west;
  options.spacing_latitude = options.spacing_longitude = GetParam().spacing;
  options.columns = options.rows = GetParam().spacing.numerator > 100 ? 30 : 121;
  options.voids = GetParam().voids;
  const RawGrid grid = syntheticGrid(options);
  const MemoryFileSystem files = buildInMemory(grid, {.leaf_cells = 8});
  Result<Database> database = Database::open(files, kMemoryDatabasePath);
  ASSERT_TRUE(database.ok());
  const GridGeometry& geometry = database.value().grid(0);
  const GridHeader& header = geometry.header();
  std::mt19937 random(7);
  for (int level = 1; level < header.level_count; ++level) {
    const Result<std::vector<Node>> nodes = nodesOfLevel(database.value(), 0, level);
    ASSERT_TRUE(nodes.ok());
    double closest = 0;
    int sampled = 0;
    for (int sample = 0; sample < 3000; ++sample) {
      const double column =
          static_cast<double>(header.x_axis.first) +
          std::uniform_real_distribution<double>(0, static_cast<double>(header.x_axis.count - 1))(random);
      const double row =
          static_cast<double>(header.y_axis.first) +
          std::uniform_real_distribution<double>(0, static_cast<double>(header.y_axis.count - 1))(random);
      const double longitude = -180 + column * header.x_axis.spacing;
      const double latitude = -90 + row * header.y_axis.spacing;
      const RowConstants row_constant = rowConstants(header.ellipsoid, latitude);
      const ColumnConstants column_constant = columnConstants(longitude);
      const Vector3 foot = earthCentred(row_constant, column_constant, 0);
      const Vector3 up = upVector(row_constant, column_constant);
      const auto fine = surfaceHeight(grid, geometry, 0, column, row, foot, up);
      const double scale = static_cast<double>(std::int64_t{1} << level);
      const auto coarse = surfaceHeight(grid, geometry, level, column / scale, row / scale, foot, up);
      if (!fine || !coarse) continue;
      ++sampled;
      const double error = std::abs(*fine - *coarse);
      const double span = header.leaf_cells * scale;
      for (const Node& node : nodes.value()) {
        if (node.record.x != static_cast<std::int32_t>(std::floor(column / span)) ||
            node.record.y != static_cast<std::int32_t>(std::floor(row / span))) {
          continue;
        }
        ASSERT_LE(error, node.geometricError())
            << "level " << level << " at " << latitude << ", " << longitude;
        closest = std::max(closest, error / node.geometricError());
      }
    }
    std::printf("%s level %d: %d samples, at most %.3f of the stored error\n", GetParam().name, level,
                sampled, closest);
    EXPECT_GT(sampled, 100);
    EXPECT_GT(closest, 0.2) << "a bound so far off says nothing";
  }
}

TEST(FacetError, the_sag_of_a_chord_counts) {
  SyntheticGridOptions options;
  options.spacing_latitude = options.spacing_longitude = {1800, 1};
  options.south = 0;
  options.columns = options.rows = 33;
  options.lowest = options.highest = 0;
  RawGrid grid = syntheticGrid(options);
  std::fill(grid.heights.begin(), grid.heights.end(), 0);
  const GridGeometry geometry(grid.header);
  // A flat Earth would have no error; level 1 has chords of a degree, 3/4 of whose sag is new: the fine ones
  // sag too, but at the posts in the middle the full 242 m (with the diagonal, 484 m) count.
  const std::vector<AncestorError> errors =
      leafErrors(grid, geometry, 2, static_cast<std::int32_t>(floorDivide(grid.header.x_axis.first, 64)),
                 static_cast<std::int32_t>(floorDivide(grid.header.y_axis.first, 64)));
  EXPECT_NEAR(errors[0].maximum * kErrorUnit, 484, 6);
}

}  // namespace
}  // namespace deltaz
