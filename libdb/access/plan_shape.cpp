#include "libdb/access/plan_shape.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace deltaz {

namespace {

constexpr double kRadians = std::numbers::pi / 180.0;
// Chords between neighbouring posts stand for arcs; the relative difference is below this for cells up to 300
// m, and for larger ones 1e-9 per square of that.
constexpr double kMargin = 1.0 + 1e-6;
constexpr std::int64_t kSamples = 16;

// Radii of curvature of the ellipsoid: of the meridian and across it.
struct Curvature {
  double meridian = 0, normal = 0;
};
Curvature curvatureAt(const EllipsoidShape& ellipsoid, double latitude_degrees) {
  const double f = ellipsoid.inverse_flattening == 0 ? 0 : 1 / ellipsoid.inverse_flattening;
  const double e2 = f * (2 - f);
  const double sine = std::sin(latitude_degrees * kRadians);
  const double w2 = 1 - e2 * sine * sine;
  return {ellipsoid.semi_major_axis * (1 - e2) / (w2 * std::sqrt(w2)),
          ellipsoid.semi_major_axis / std::sqrt(w2)};
}

CellSize largestGeodeticCell(const GridGeometry& geometry, PostRange rows) {
  const GridHeader& header = geometry.header();
  const double south = geometry.latitude(rows.begin), north = geometry.latitude(rows.end - 1);
  const double nearest_equator = south <= 0 && north >= 0 ? 0.0 : std::min(std::abs(south), std::abs(north));
  const double farthest = std::max(std::abs(south), std::abs(north));
  // N cos(lat) falls and M grows towards the poles (on a sphere both claims hold with equality for M; a
  // prolate ellipsoid cannot be named).
  return {curvatureAt(header.ellipsoid, nearest_equator).normal * std::cos(nearest_equator * kRadians) *
              header.x_axis.spacing * kRadians * kMargin,
          curvatureAt(header.ellipsoid, farthest).meridian * header.y_axis.spacing * kRadians * kMargin};
}

// Up to kSamples + 1 indices spread over a range, its ends included.
std::vector<std::int64_t> spread(PostRange range) {
  const std::int64_t last = range.size() - 1, count = std::min(last, kSamples);
  std::vector<std::int64_t> indices;
  for (std::int64_t i = 0; i <= count; ++i)
    indices.push_back(range.begin + last * i / std::max<std::int64_t>(1, count));
  return indices;
}

// Largest value of a field sampled on rows x columns, plus the largest difference of neighbouring samples.
double boundOf(const std::vector<double>& values, std::size_t columns) {
  double largest = 0, change = 0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    largest = std::max(largest, values[i]);
    if (i % columns != 0) change = std::max(change, std::abs(values[i] - values[i - 1]));
    if (i >= columns) change = std::max(change, std::abs(values[i] - values[i - columns]));
  }
  return largest + change;
}

CellSize largestProjectedCell(const GridGeometry& geometry, PostRange columns, PostRange rows) {
  const std::vector<std::int64_t> xs = spread(columns), ys = spread(rows);
  std::vector<double> widths, heights, skews;
  for (const std::int64_t y : ys) {
    for (const std::int64_t x : xs) {
      // The step towards the inside at the eastern and northern end.
      const std::int64_t dx = x + 1 < columns.end ? 1 : -1, dy = y + 1 < rows.end ? 1 : -1;
      const Vector3 foot = geometry.placeAt(x, y).foot;
      const Vector3 east = (geometry.placeAt(x + dx, y).foot - foot) * static_cast<double>(dx);
      const Vector3 north = (geometry.placeAt(x, y + dy).foot - foot) * static_cast<double>(dy);
      widths.push_back(length(east));
      heights.push_back(length(north));
      skews.push_back(std::abs(dot(east, north)) / (widths.back() * heights.back()));
    }
  }
  // |u e + v n|^2 <= (1 + |cos|) (u^2 e^2 + v^2 n^2).
  const double skew = std::sqrt(1 + std::min(1.0, boundOf(skews, xs.size()))) * kMargin;
  return {boundOf(widths, xs.size()) * skew, boundOf(heights, xs.size()) * skew};
}

double geodeticBow(const GridGeometry& geometry, int level, PostRange rows) {
  const GridHeader& header = geometry.header();
  const double south = geometry.latitude(rows.begin) * kRadians;
  const double north = geometry.latitude(rows.end - 1) * kRadians;
  const double largest_sine = std::max(std::abs(std::sin(south)), std::abs(std::sin(north)));
  const double largest_cosine = south <= 0 && north >= 0 ? 1.0 : std::max(std::cos(south), std::cos(north));
  const double scale = static_cast<double>(std::int64_t{1} << level) * kRadians;
  const double width = header.x_axis.spacing * scale, height = header.y_axis.spacing * scale;
  return 1.25 * header.ellipsoid.semi_major_axis / 8 * largest_sine * width *
         std::hypot(largest_cosine * width, 2 * height);
}

// Of an edge of one post, without the error of the control points.
double projectedBow(const GridGeometry& geometry) {
  // A regular net over the area, a little beyond it where that takes fewer than four samples.
  const PostRange all_columns = geometry.columnsAt(0), all_rows = geometry.rowsAt(0);
  int net_level = 0;
  while ((std::max(all_columns.size(), all_rows.size()) >> net_level) > 64) ++net_level;
  const std::int64_t step = std::int64_t{1} << net_level;
  const auto net = [step](PostRange posts) {
    PostRange range{floorDivide(posts.begin, step), ceilDivide(posts.end - 1, step) + 1};
    range.end = std::max(range.end, range.begin + 4);
    return range;
  };
  const PostRange columns = net(all_columns), rows = net(all_rows);
  const std::vector<PostPlace> places = geometry.postPlaces(net_level, columns, rows);
  const auto at = [&](std::int64_t i, std::int64_t j) -> const PostPlace& {
    return places[static_cast<std::size_t>(j * columns.size() + i)];
  };
  constexpr std::array<std::array<std::int64_t, 2>, 3> kDirections = {{{1, 0}, {0, 1}, {1, 1}}};
  double acceleration = 0, change = 0;  // metres per net step squared
  for (const auto& [di, dj] : kDirections) {
    for (std::int64_t j = dj; j + dj < rows.size(); ++j) {
      for (std::int64_t i = di; i + di < columns.size(); ++i) {
        const PostPlace& here = at(i, j);
        const Vector3 before = at(i - di, j - dj).foot, after = at(i + di, j + dj).foot;
        const Vector3 sideways = cross(after - before, here.up);
        const double size = length(sideways);
        if (!(size > 0)) continue;
        const Vector3 second = after - here.foot * 2 + before;
        acceleration = std::max(acceleration, std::abs(dot(second, sideways)) / size);
        if (i + 2 * di >= columns.size() || j + 2 * dj >= rows.size()) continue;
        const Vector3 third = at(i + 2 * di, j + 2 * dj).foot - after * 3 + here.foot * 3 - before;
        change = std::max(change, std::abs(dot(third, sideways)) / size);
      }
    }
  }
  const double edge = 1 / static_cast<double>(step);
  return 1.25 * (acceleration + change) * edge * edge / 8;
}

double angleBetween(const Vector3& a, const Vector3& b) {
  return std::atan2(length(cross(a, b)), dot(a, b));
}

// The largest angle between the ellipsoid normals at opposite corners of a cell of `level`.
double projectedTurn(const GridGeometry& geometry, int level) {
  // A level may have no whole cell in the area: then a finer one's are scaled, with a hundredth more for the
  // scale of the projection, which varies.
  int whole = level;
  while (whole > 0 && (geometry.columnsAt(whole).size() < 2 || geometry.rowsAt(whole).size() < 2)) --whole;
  const PostRange columns = geometry.columnsAt(whole), rows = geometry.rowsAt(whole);
  const std::vector<PostPlace> places = geometry.postPlaces(whole, columns, rows);
  const auto up = [&](std::int64_t i, std::int64_t j) {
    return places[static_cast<std::size_t>(j * columns.size() + i)].up;
  };
  double turn = 0;
  for (std::int64_t j = 0; j + 1 < rows.size(); ++j) {
    for (std::int64_t i = 0; i + 1 < columns.size(); ++i) {
      turn = std::max(
          {turn, angleBetween(up(i, j), up(i + 1, j + 1)), angleBetween(up(i + 1, j), up(i, j + 1))});
    }
  }
  return turn * 1.01 * static_cast<double>(std::int64_t{1} << (level - whole));
}

}  // namespace

double CellSize::diagonal() const {
  return std::hypot(width, height);
}

CellSize largestCell(const GridGeometry& geometry, PostRange columns, PostRange rows) {
  return geometry.isGeodetic() ? largestGeodeticCell(geometry, rows)
                               : largestProjectedCell(geometry, columns, rows);
}

SidewaysBow::SidewaysBow(const GridGeometry& geometry) : geometry_(geometry) {
  if (geometry.isGeodetic()) return;
  of_one_post_ = projectedBow(geometry);
  of_patches_ = 2 * geometry.patches()->placement.error;
}

double SidewaysBow::at(int level, PostRange rows) const {
  if (geometry_.isGeodetic()) return geodeticBow(geometry_, level, rows);
  const double posts = static_cast<double>(std::int64_t{1} << level);
  return of_one_post_ * posts * posts + of_patches_;
}

bool coversGround(const Vector3& foot_a, const Vector3& foot_b, const Vector3& foot_c) {
  constexpr double kDegenerate = 1e-12;
  const Vector3 ab = foot_b - foot_a, ac = foot_c - foot_a;
  return length(cross(ab, ac)) > kDegenerate * std::max(dot(ab, ab), dot(ac, ac));
}

double chordSag(const GridGeometry& geometry, int level, double highest) {
  const GridHeader& header = geometry.header();
  const double turn = geometry.isGeodetic() ? std::hypot(header.x_axis.spacing, header.y_axis.spacing) *
                                                  kRadians * static_cast<double>(std::int64_t{1} << level)
                                            : projectedTurn(geometry, level);
  const double distance = header.ellipsoid.semi_major_axis + std::abs(highest);
  return distance * (1.0 - std::cos(std::min(turn / 2, std::numbers::pi / 2)));
}

}  // namespace deltaz
