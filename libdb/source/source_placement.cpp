#include "libdb/source/source_placement.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>

#include "libdb/access/grid_geometry.h"
#include "libdb/source/grid_placement.h"
#include "libdb/source/source_error.h"

namespace deltaz {

namespace {

constexpr double kMetresPerDegree = 111319.49;

// The largest index of a post the format holds, and more than any grid has.
constexpr double kMostPosts = 2147483647.0;

// Where a source's first and last post along an axis lie.
struct Reach {
  double first = 0, last = 0;
};

const char* const kRoundingRemedy =
    "Give it an exact georeferencing, with gdal_edit.py -a_ullr or gdal_translate -a_ullr";

// An axis of degrees that reaches `excess` too far: placed exactly, if its numbers are an exact axis'
// rounded.
GridAxis placeRounded(const Reach& reach, double spacing, std::int64_t count, const AxisOrigin& origin,
                      double excess) {
  if (excess <= kPlacementTolerance || excess > kRoundedGeoreferencing * spacing)
    return placeAxis(reach.first, spacing, count, origin);
  return placeAxis(reach.first, spacing, count, origin, kPlacementTolerance + 2 * excess);
}

Reach reachOf(const GridAxis& axis, const AxisOrigin& origin) {
  return {postCoordinate(axis, origin, axis.first),
          postCoordinate(axis, origin, axis.first + axis.count - 1)};
}

Status placeGeodetic(const SourceDescription& source, const std::string& path, GridHeader& header,
                     std::vector<std::string>& warnings) {
  const std::array<double, 6>& transform = source.geotransform;
  const double spacing_y = std::abs(transform[5]);
  double west = transform[0] + 0.5 * transform[1];
  const double first_row = transform[3] + 0.5 * transform[5];
  const double last_row = transform[3] + (static_cast<double>(source.rows) - 0.5) * transform[5];
  const double south = std::min(first_row, last_row);
  const double north = std::max(first_row, last_row);
  const double width = static_cast<double>(source.columns - 1) * transform[1];
  if (width > 360 + kRoundedGeoreferencing * transform[1] || std::abs(west) > 720)
    return refusedSource(path, "the source goes more than once round the Earth", {}, kRoundingRemedy);
  // The west edge in [-180, 180), also when rounding left it a hair below.
  while (west < -180 - kPlacementTolerance) west += 360;
  while (west >= 180 - kPlacementTolerance) west -= 360;
  header.x_axis =
      placeRounded({west, west + width}, transform[1], source.columns, kLongitudeOrigin, width - 360);
  header.y_axis = placeRounded({south, north}, spacing_y, source.rows, kLatitudeOrigin,
                               std::max(-90 - south, north - 90));
  const Reach rows = reachOf(header.y_axis, kLatitudeOrigin);
  if (rows.first < -90 - kPlacementTolerance || rows.last > 90 + kPlacementTolerance) {
    return refusedSource(path, fmt::format("the source reaches from latitude {} to {}", south, north),
                         "there is no such latitude", kRoundingRemedy);
  }
  const Reach columns = reachOf(header.x_axis, kLongitudeOrigin);
  const double moved = std::max({std::abs(rows.first - south), std::abs(rows.last - north),
                                 std::abs(columns.first - west), std::abs(columns.last - west - width)});
  if (moved > 1.5 * kPlacementTolerance) {
    warnings.push_back(
        fmt::format("{}: its georeferencing is rounded and reaches too far round the Earth; posts are placed "
                    "where the exact one has them, up to {:.2g} m off",
                    path, moved * kMetresPerDegree));
  }
  return Success{};
}

// By how many cells rotation terms move a source's posts.
double rotationOf(const SourceDescription& source) {
  const std::array<double, 6>& transform = source.geotransform;
  return std::max(std::abs(transform[2] / transform[1]) * static_cast<double>(source.rows),
                  std::abs(transform[4] / transform[5]) * static_cast<double>(source.columns));
}

}  // namespace

Status placeSource(const SourceDescription& source, const std::string& path, const ReferenceSystem& system,
                   GridHeader& header, std::vector<std::string>& warnings) {
  const std::array<double, 6>& transform = source.geotransform;
  for (const double value : transform) {
    if (!std::isfinite(value)) return refusedSource(path, "the source's georeferencing is not finite");
  }
  const bool rotated = transform[2] != 0 || transform[4] != 0;
  if (rotated && (transform[1] == 0 || transform[5] == 0 || rotationOf(source) > kNoRotation)) {
    return refusedSource(path, "the source is rotated against its coordinate axes", {},
                         "Warp it north-up first, with gdalwarp");
  }
  if (!(transform[1] > 0) || transform[5] == 0)
    return refusedSource(path, "the source's columns do not run from west to east");
  if (source.columns < 2 || source.rows < 2)
    return refusedSource(path, "the source has fewer than 2 x 2 posts");
  const double least = system.projected ? kLeastSpacingProjected : kLeastSpacingDegrees;
  const double spacing_y = std::abs(transform[5]);
  if (transform[1] < least || spacing_y < least) {
    return refusedSource(path, "the source's posts are less than 0.1 mm apart",
                         "its georeferencing is hardly meant so");
  }
  header.kind = system.projected ? "projected" : "geodetic";
  if (!system.projected) return placeGeodetic(source, path, header, warnings);
  const double west = transform[0] + 0.5 * transform[1];
  const double first_row = transform[3] + 0.5 * transform[5];
  const double last_row = transform[3] + (static_cast<double>(source.rows) - 0.5) * transform[5];
  if (std::abs(west) / transform[1] > kMostPosts || std::abs(first_row) / spacing_y > kMostPosts ||
      std::abs(last_row) / spacing_y > kMostPosts) {
    return refusedSource(path, "the source lies too far from its origin for so small a spacing of posts");
  }
  header.x_axis = placeAxis(west, transform[1], source.columns, kProjectedOrigin);
  header.y_axis = placeAxis(std::min(first_row, last_row), spacing_y, source.rows, kProjectedOrigin);
  return Success{};
}

}  // namespace deltaz
