#include "libdb/access/vertex_normals.h"

#include <bit>
#include <cmath>
#include <cstdint>
#include <functional>
#include <gtest/gtest.h>
#include <map>
#include <numbers>
#include <tuple>

#include "libdb/build/pyramid.h"
#include "tests/stress/stress_grids.h"
#include "tests/support/every_simd_target.h"
#include "tests/support/synthetic_grid.h"

namespace deltaz {
namespace {

constexpr std::array<std::array<int, 2>, 6> kSteps = {{{1, 0}, {1, 1}, {0, 1}, {-1, 0}, {-1, -1}, {0, -1}}};

double degreesBetween(const Vector3& a, const Vector3& b) {
  return std::atan2(length(cross(a, b)), dot(a, b)) * 180 / std::numbers::pi;
}

Vector3 normalOnPlane(const std::function<double(double, double)>& height, double x, double y, double spacing,
                      int exponent) {
  std::array<VertexNeighbour, 6> neighbours;
  for (std::size_t k = 0; k < 6; ++k) {
    const double dx = kSteps[k][0] * spacing, dy = kSteps[k][1] * spacing;
    neighbours[k] = {{dx, dy, height(x + dx, y + dy) - height(x, y)}, true};
  }
  return table11Normal(neighbours, {0, 0, 1}, exponent);
}

// RMS error over the square of +-0.6 radius on top of a sphere of 2000 m, at posts of every sub-post phase.
double rmsOnSphere(double spacing, int exponent) {
  constexpr double kRadius = 2000;
  constexpr int kSamples = 96;
  const auto height = [](double x, double y) { return std::sqrt(kRadius * kRadius - x * x - y * y); };
  double sum = 0;
  for (int i = 0; i < kSamples; ++i) {
    for (int j = 0; j < kSamples; ++j) {
      const double x = kRadius * 0.6 * (2.0 * (i + 0.5) / kSamples - 1);
      const double y = kRadius * 0.6 * (2.0 * (j + 0.5) / kSamples - 1);
      const double error =
          degreesBetween(normalOnPlane(height, x, y, spacing, exponent), {x, y, height(x, y)});
      sum += error * error;
    }
  }
  return std::sqrt(sum / (kSamples * kSamples));
}

// The digest states .0798, .0478, .0282, .0524 degree but not over which part of the sphere; +-0.6 radius
// gives all four within 1.5 %.
TEST(VertexNormals, sphere_errors_are_those_of_the_digest) {
  const std::map<int, double> expected = {{0, 0.0798}, {1, 0.0478}, {2, 0.0282}, {4, 0.0524}};
  for (const auto& [exponent, degrees] : expected) {
    const double measured = rmsOnSphere(90, exponent);
    RecordProperty("rms_p" + std::to_string(exponent), std::to_string(measured));
    std::printf("sphere 2000 m, 90 m posts, p = %d: %.4f degree rms (digest %.4f)\n", exponent, measured,
                degrees);
    EXPECT_NEAR(measured, degrees, 0.015 * degrees) << "p = " << exponent;
  }
  EXPECT_LT(rmsOnSphere(90, 2), rmsOnSphere(90, 0));
  EXPECT_LT(rmsOnSphere(90, 2), rmsOnSphere(90, 1));
}

TEST(VertexNormals, error_falls_with_the_square_of_the_spacing) {
  const double ratio = rmsOnSphere(90, 2) / rmsOnSphere(30, 2);
  std::printf("three times finer posts: %.2f times better\n", ratio);
  EXPECT_GE(ratio, 8);
  EXPECT_LE(ratio, 10);
}

TEST(VertexNormals, a_plane_is_exact_for_any_exponent) {
  const auto plane = [](double x, double y) { return 0.3 * x - 0.7 * y; };
  for (const int exponent : {0, 1, 2, 4}) {
    EXPECT_LT(degreesBetween(normalOnPlane(plane, 10, 20, 90, exponent), {-0.3, 0.7, 1}), 1.3e-6);
  }
}

// Table 11 once more, straight from its definition, on positions computed in long double.
Vector3 independentNormal(const RawGrid& grid, const GridGeometry& geometry, int level, std::int64_t column,
                          std::int64_t row) {
  using Real = long double;
  using Triple = std::array<Real, 3>;
  const GridHeader& header = grid.header;
  constexpr Real kRadians = std::numbers::pi_v<Real> / 180;
  const Real f = 1 / static_cast<Real>(header.ellipsoid.inverse_flattening), e2 = f * (2 - f);
  const std::int64_t step = std::int64_t{1} << level;
  const auto local = [&](std::int64_t i, std::int64_t j) {
    return std::array{i * step - header.x_axis.first, j * step - header.y_axis.first};
  };
  const auto valid = [&](std::int64_t i, std::int64_t j) {
    const auto [c, r] = local(i, j);
    return c >= 0 && c < header.x_axis.count && r >= 0 && r < header.y_axis.count && grid.isValid(c, r);
  };
  const auto position = [&](std::int64_t i, std::int64_t j) {
    const auto [c, r] = local(i, j);
    const Real latitude = geometry.latitude(j * step), longitude = geometry.longitude(i * step) * kRadians;
    const Real sine = std::sin(latitude * kRadians);
    // The pole is a point, which pi / 2 in any precision is not.
    const Real cosine = std::abs(latitude) == 90 ? 0 : std::sin((90 - std::abs(latitude)) * kRadians);
    const Real n = header.ellipsoid.semi_major_axis / std::sqrt(1 - e2 * sine * sine);
    const Real height = geometry.metres(grid.height(c, r));
    return Triple{(n + height) * cosine * std::cos(longitude), (n + height) * cosine * std::sin(longitude),
                  (n * (1 - e2) + height) * sine};
  };
  Triple sum{};
  for (std::size_t k = 0; k < 6; ++k) {
    const auto [ai, aj] = kSteps[k];
    const auto [bi, bj] = kSteps[(k + 1) % 6];
    if (!valid(column + ai, row + aj) || !valid(column + bi, row + bj)) continue;
    const Triple v = position(column, row), a = position(column + ai, row + aj),
                 b = position(column + bi, row + bj);
    Triple d1, d2, centroid;
    for (std::size_t q = 0; q < 3; ++q) {
      d1[q] = a[q] - v[q];
      d2[q] = b[q] - v[q];
      centroid[q] = (v[q] + a[q] + b[q]) / 3;
    }
    Real squared = 0;
    for (std::size_t q = 0; q < 3; ++q) squared += (centroid[q] - v[q]) * (centroid[q] - v[q]);
    if (squared == 0) continue;
    for (std::size_t q = 0; q < 3; ++q) {
      const std::size_t r = (q + 1) % 3, s = (q + 2) % 3;
      sum[q] += (d1[r] * d2[s] - d1[s] * d2[r]) / squared;
    }
  }
  const Real size = std::sqrt(sum[0] * sum[0] + sum[1] * sum[1] + sum[2] * sum[2]);
  if (size == 0)
    return upVector(rowConstants(header.ellipsoid, geometry.latitude(row * step)),
                    columnConstants(geometry.longitude(column * step)));
  return {static_cast<double>(sum[0] / size), static_cast<double>(sum[1] / size),
          static_cast<double>(sum[2] / size)};
}

std::vector<TerrainTile> tilesOf(const RawGrid& grid, const GridGeometry& geometry, int level) {
  std::vector<TerrainTile> tiles;
  const PostRange columns = geometry.nodeColumnsAt(level), rows = geometry.nodeRowsAt(level);
  for (std::int64_t y = rows.begin; y < rows.end; ++y) {
    for (std::int64_t x = columns.begin; x < columns.end; ++x) {
      tiles.push_back(
          cutTile(grid, geometry, level, static_cast<std::int32_t>(x), static_cast<std::int32_t>(y)));
    }
  }
  return tiles;
}

struct Place {
  const char* name;
  SyntheticGridOptions options;
};

SyntheticGridOptions areaAt(double south, double west, Rational spacing, VoidPattern voids) {
  SyntheticGridOptions options;
  options.south = south;
  options.west = west;
  options.spacing_latitude = options.spacing_longitude = spacing;
  options.voids = voids;
  return options;
}

class VertexNormalsAt : public testing::TestWithParam<Place> {};

INSTANTIATE_TEST_SUITE_P(
    , VertexNormalsAt,
    testing::Values(Place{"mid_latitude", areaAt(43, -80, {3, 1}, VoidPattern::kNone)},
                    Place{"holes", areaAt(46, -122, {1, 1}, VoidPattern::kHole)},
                    Place{"scattered_voids", areaAt(27, 86, {3, 1}, VoidPattern::kScattered)},
                    Place{"equator", areaAt(-1, 10, {30, 1}, VoidPattern::kNone)},
                    Place{"north_pole", areaAt(89, -80, {30, 1}, VoidPattern::kNone)},
                    Place{"north_pole_fine", areaAt(90 - 120.0 / 3600, -80, {1, 1}, VoidPattern::kNone)},
                    Place{"south_pole", areaAt(-90, 20, {30, 1}, VoidPattern::kScattered)},
                    Place{"antimeridian", areaAt(60, 179.5, {30, 1}, VoidPattern::kNone)}),
    [](const auto& place) { return std::string(place.param.name); });

TEST_P(VertexNormalsAt, agree_with_an_independent_table_11_and_are_finite_unit_vectors) {
  const RawGrid grid = syntheticGrid(GetParam().options);
  const GridGeometry geometry(grid.header);
  double worst = 0;
  for (int level = 0; level < 2; ++level) {
    for (const TerrainTile& tile : tilesOf(grid, geometry, level)) {
      const std::vector<Vector3> normals = vertexNormals(tile, geometry);
      std::size_t k = 0;
      for (int j = 0; j < tile.rows; ++j) {
        for (int i = 0; i < tile.columns; ++i, ++k) {
          ASSERT_TRUE(std::isfinite(normals[k].x) && std::isfinite(normals[k].y) &&
                      std::isfinite(normals[k].z));
          ASSERT_NEAR(length(normals[k]), 1, 1e-12);
          if (!tile.isValid(i, j)) continue;
          const Vector3 expected =
              independentNormal(grid, geometry, level, tile.first_column + i, tile.first_row + j);
          const Vector3 difference = normals[k] - expected;
          worst = std::max({worst, std::abs(difference.x), std::abs(difference.y), std::abs(difference.z)});
        }
      }
    }
  }
  std::printf("%s: largest difference %.2g (bound %.0g)\n", GetParam().name, worst, kVertexNormalTolerance);
  EXPECT_LE(worst, kVertexNormalTolerance);
}

TEST_P(VertexNormalsAt, are_the_same_bits_on_both_sides_of_every_border) {
  const RawGrid grid = syntheticGrid(GetParam().options);
  const GridGeometry geometry(grid.header);
  std::map<std::pair<std::int64_t, std::int64_t>, Vector3> seen;
  std::size_t shared = 0;
  for (const TerrainTile& tile : tilesOf(grid, geometry, 0)) {
    const std::vector<Vector3> normals = vertexNormals(tile, geometry);
    for (int j = 0; j < tile.rows; ++j) {
      for (int i = 0; i < tile.columns; ++i) {
        const Vector3& normal = normals[static_cast<std::size_t>(j * tile.columns + i)];
        const auto [it, fresh] = seen.emplace(std::pair(tile.first_column + i, tile.first_row + j), normal);
        if (fresh) continue;
        ++shared;
        ASSERT_EQ(it->second, normal);
      }
    }
  }
  EXPECT_GT(shared, 100u);
}

// From post (i, j) to post (i + di, j + dj) of a geodetic grid: products of constants and heights change by
// the constant's change times one height plus the height's times the other.
Vector3 offsetBetween(const TerrainTile& tile, const GridGeometry& geometry, int i, int j, int di, int dj) {
  const std::int64_t step = std::int64_t{1} << tile.level;
  const auto latitude = [&](int row) { return geometry.latitude((tile.first_row + row) * step); };
  const auto longitude = [&](int column) { return geometry.longitude((tile.first_column + column) * step); };
  const EllipsoidShape& ellipsoid = geometry.header().ellipsoid;
  const RowConstants from = rowConstants(ellipsoid, latitude(j)),
                     to = rowConstants(ellipsoid, latitude(j + dj));
  const ColumnConstants to_column = columnConstants(longitude(i + di));
  const RowStep r =
      dj == 0 ? RowStep{} : rowStep(ellipsoid, latitude(dj > 0 ? j : j - 1), latitude(dj > 0 ? j + 1 : j));
  const ColumnStep c =
      di == 0 ? ColumnStep{} : columnStep(longitude(di > 0 ? i : i - 1), longitude(di > 0 ? i + 1 : i));
  const double height = geometry.metres(tile.height(i, j));
  const double rise = geometry.metres(tile.height(i + di, j + dj)) - height;
  const double distance = from.a + from.b * height;
  const double distance_step = dj * (r.a + r.b * height) + to.b * rise;
  return {distance_step * to_column.cosine + distance * di * c.cosine,
          distance_step * to_column.sine + distance * di * c.sine, dj * (r.c + r.s * height) + to.s * rise};
}

Vector3 normalByDefinition(const TerrainTile& tile, const GridGeometry& geometry, int i, int j) {
  const std::int64_t step = std::int64_t{1} << tile.level;
  const auto place = [&](int at_i, int at_j) {
    return geometry.placeAt((tile.first_column + at_i) * step, (tile.first_row + at_j) * step);
  };
  const Vector3 up = place(i, j).up;
  if (!tile.isValid(i, j)) return up;
  std::array<VertexNeighbour, 6> neighbours;
  for (std::size_t k = 0; k < 6; ++k) {
    const auto [di, dj] = kSteps[k];
    const Vector3 offset = geometry.isGeodetic()
                               ? offsetBetween(tile, geometry, i, j, di, dj)
                               : place(i + di, j + dj).at(geometry.metres(tile.height(i + di, j + dj))) -
                                     place(i, j).at(geometry.metres(tile.height(i, j)));
    neighbours[k] = {offset, tile.isValid(i + di, j + dj)};
  }
  return table11Normal(neighbours, up);
}

void expectDefinition(const TerrainTile& tile, const GridGeometry& geometry) {
  std::vector<Vector3> expected;
  for (int j = 0; j < tile.rows; ++j) {
    for (int i = 0; i < tile.columns; ++i) expected.push_back(normalByDefinition(tile, geometry, i, j));
  }
  onEverySimdTarget([&] {
    const std::vector<Vector3> normals = vertexNormals(tile, geometry);
    ASSERT_EQ(normals.size(), expected.size());
    std::size_t different = 0;
    const auto bits = [](double value) { return std::bit_cast<std::uint64_t>(value); };
    for (std::size_t k = 0; k < normals.size(); ++k)
      different += bits(normals[k].x) == bits(expected[k].x) && bits(normals[k].y) == bits(expected[k].y) &&
                           bits(normals[k].z) == bits(expected[k].z)
                       ? 0
                       : 1;
    EXPECT_EQ(different, 0U) << tile.columns << " x " << tile.rows;
  });
}

TEST(VertexNormals, have_the_definitions_bits_on_every_instruction_set) {
  for (const NamedGrid& named : extremeGrids()) {
    SCOPED_TRACE(named.name);
    expectDefinition(wholeTile(named.grid), GridGeometry(named.grid.header, named.grid.patches));
  }
  const RawGrid projected = projectedGrid(90, 40, 25);
  expectDefinition(wholeTile(projected), GridGeometry(projected.header, projected.patches));
}

TEST(VertexNormals, of_tiles_of_any_width_and_with_voids_have_the_definitions_bits) {
  for (int columns = 1; columns <= 19; ++columns) {
    for (const VoidPattern voids : {VoidPattern::kNone, VoidPattern::kScattered}) {
      SyntheticGridOptions options;
      options.columns = columns;
      options.rows = 5;
      options.voids = voids;
      const RawGrid grid = syntheticGrid(options);
      TerrainTile tile = wholeTile(grid);
      expectDefinition(tile, GridGeometry(grid.header));
      // A ring that is there: no validity is asked for.
      if (voids == VoidPattern::kNone) tile.valid.assign(tile.valid.size(), 1);
      expectDefinition(tile, GridGeometry(grid.header));
    }
  }
}

}  // namespace
}  // namespace deltaz
