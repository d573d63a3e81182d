#include "libdb/source/synthetic_grid.h"

#include <algorithm>
#include <cmath>

namespace deltaz {
namespace {

const char* const kGeographicWgs84 =
    "GEOGCRS[\"WGS 84\",DATUM[\"World Geodetic System 1984\",ELLIPSOID[\"WGS 84\",6378137,298.257223563,"
    "LENGTHUNIT[\"metre\",1]]],PRIMEM[\"Greenwich\",0,ANGLEUNIT[\"degree\",0.0174532925199433]],CS["
    "ellipsoidal,2],"
    "AXIS[\"geodetic latitude (Lat)\",north,ORDER[1],ANGLEUNIT[\"degree\",0.0174532925199433]],"
    "AXIS[\"geodetic longitude "
    "(Lon)\",east,ORDER[2],ANGLEUNIT[\"degree\",0.0174532925199433]],ID[\"EPSG\",4326]]";

std::uint32_t mixed(std::uint32_t seed, std::uint32_t x, std::uint32_t y) {
  std::uint32_t value = seed * 0x9E3779B9u ^ x * 0x85EBCA6Bu ^ y * 0xC2B2AE35u;
  value ^= value >> 16;
  value *= 0x7FEB352Du;
  value ^= value >> 15;
  value *= 0x846CA68Bu;
  return value ^ (value >> 16);
}

// Value noise of one octave at a post: 0 .. 65535, in integers so that every machine agrees.
std::int64_t noise(std::uint32_t seed, std::int64_t column, std::int64_t row, std::int64_t period) {
  const std::int64_t cell_x = column / period, cell_y = row / period;
  const std::int64_t u = column % period, v = row % period;
  const auto corner = [&](std::int64_t x, std::int64_t y) {
    return static_cast<std::int64_t>(
        mixed(seed, static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y)) & 0xFFFF);
  };
  const std::int64_t south = corner(cell_x, cell_y) * (period - u) + corner(cell_x + 1, cell_y) * u;
  const std::int64_t north = corner(cell_x, cell_y + 1) * (period - u) + corner(cell_x + 1, cell_y + 1) * u;
  return (south * (period - v) + north * v) / (period * period);
}

GridAxis axisFrom(const AxisOrigin& origin, double start, const Rational& spacing, std::int64_t count) {
  GridAxis axis;
  axis.exact_spacing = spacing;
  axis.spacing = static_cast<double>(spacing.numerator) / (3600.0 * static_cast<double>(spacing.denominator));
  const double posts = (start - origin.coordinate) * 3600.0 * static_cast<double>(spacing.denominator) /
                       static_cast<double>(spacing.numerator);
  // A start meant to lie on a multiple does, whatever the division rounds to.
  const double nearest = std::round(posts);
  const bool on_grid = std::abs(posts - nearest) < 1e-6;
  axis.first = static_cast<std::int64_t>(on_grid ? nearest : std::floor(posts));
  axis.phase = on_grid ? 0.0 : posts - std::floor(posts);
  axis.count = count;
  return axis;
}

bool isVoid(const SyntheticGridOptions& options, std::int64_t column, std::int64_t row) {
  const std::int64_t dx = column - options.columns / 2, dy = row - options.rows / 2;
  switch (options.voids) {
    case VoidPattern::kNone:
      return false;
    case VoidPattern::kScattered:
      return mixed(options.seed + 99, static_cast<std::uint32_t>(column), static_cast<std::uint32_t>(row)) %
                 20 ==
             0;
    case VoidPattern::kHole: {
      const std::int64_t radius = std::min(options.columns, options.rows) / 4;
      return dx * dx + dy * dy <= radius * radius;
    }
    case VoidPattern::kWestHalf:
      return dx < 0;
    case VoidPattern::kSingle:
      return dx == 0 && dy == 0;
  }
  return false;
}

}  // namespace

RawGrid syntheticGrid(const SyntheticGridOptions& options) {
  RawGrid grid;
  GridHeader& header = grid.header;
  header.crs_wkt = kGeographicWgs84;
  header.horizontal_datum = "WGS 84";
  header.vertical_datum = "EGM96 height";
  header.unit = "metre";
  header.quantum = options.quantum;
  header.x_axis = axisFrom(kLongitudeOrigin, options.west, options.spacing_longitude, options.columns);
  header.y_axis = axisFrom(kLatitudeOrigin, options.south, options.spacing_latitude, options.rows);

  SourceDescription source;
  source.name = "synthetic.tif";
  source.content = hash128({});
  source.driver = "GTiff";
  source.data_type = "Int16";
  source.nodata = -32768;
  source.unit = std::string("m");
  source.columns = options.columns;
  source.rows = options.rows;
  const double dx = header.x_axis.spacing, dy = header.y_axis.spacing;
  const double north = options.south + dy * static_cast<double>(options.rows - 1);
  source.geotransform = {options.west - dx / 2, dx, 0, north + dy / 2, 0, -dy};
  header.sources.push_back(source);

  const auto span = static_cast<std::int64_t>(options.highest) - options.lowest;
  grid.heights.reserve(static_cast<std::size_t>(options.columns * options.rows));
  for (std::int64_t row = 0; row < options.rows; ++row) {
    for (std::int64_t column = 0; column < options.columns; ++column) {
      const std::int64_t sum =
          8 * noise(options.seed, column, row, 37) + 4 * noise(options.seed + 1, column, row, 17) +
          2 * noise(options.seed + 2, column, row, 7) + noise(options.seed + 3, column, row, 3);
      grid.heights.push_back(static_cast<std::int32_t>(options.lowest + sum * span / (15 * 65535)));
      if (options.voids != VoidPattern::kNone) grid.valid.push_back(isVoid(options, column, row) ? 0 : 1);
    }
  }
  return grid;
}

}  // namespace deltaz
