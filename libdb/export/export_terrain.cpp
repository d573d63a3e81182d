#include "libdb/export/export_terrain.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cpl_string.h>
#include <fmt/format.h>
#include <gdal_priv.h>
#include <ogr_spatialref.h>
#include <unistd.h>

#include "formats/file_system.h"
#include "libdb/source/full_turn.h"
#include "libdb/source/gdal_session.h"
#include "libdb/source/grid_cutting.h"
#include "libdb/source/height_units.h"
#include "libdb/source/reference_system.h"
#include "libdb/source/stored_values.h"

namespace deltaz {

namespace {

// Used where a grid has voids and nothing says what stood there.
constexpr double kDefaultNodata = -32768;

// What the axis of the area becomes at `level`.
GridAxis axisAt(const GridAxis& axis, PostRange posts, int level) {
  GridAxis coarse = axis;
  const double step = static_cast<double>(std::int64_t{1} << level);
  coarse.spacing *= step;
  coarse.phase /= step;
  if (coarse.exact_spacing) coarse.exact_spacing->numerator *= std::int64_t{1} << level;
  coarse.first = posts.begin;
  coarse.count = posts.size();
  return coarse;
}

struct Origins {
  AxisOrigin x, y;
};
Origins originsOf(const GridHeader& header) {
  if (header.kind == "geodetic") return {kLongitudeOrigin, kLatitudeOrigin};
  return {kProjectedOrigin, kProjectedOrigin};
}

// Posts are the middles of pixels.
std::array<double, 6> geotransformOf(const GridHeader& header) {
  const Origins origins = originsOf(header);
  const double west = postCoordinate(header.x_axis, origins.x, header.x_axis.first);
  const double north =
      postCoordinate(header.y_axis, origins.y, header.y_axis.first + header.y_axis.count - 1);
  return {west - 0.5 * header.x_axis.spacing,
          header.x_axis.spacing,
          0,
          north + 0.5 * header.y_axis.spacing,
          0,
          -header.y_axis.spacing};
}

// Whole columns from the source's first to the grid's. A meridian has many longitudes: the source's own where
// it has the grid's columns, else those near its own, as long as they are ordinary ones.
double turnLike(const SourceDescription& source, const GridHeader& header, double columns) {
  const double count = static_cast<double>(header.x_axis.count);
  if (header.kind != "geodetic") return std::round(columns);
  const double turn = 360 / source.geotransform[1];
  for (const double turns : {0.0, 1.0, -1.0, 2.0, -2.0}) {
    const double first = std::round(columns + turns * turn);
    if (first >= 0 && first + count <= static_cast<double>(source.columns)) return first;
  }
  const double near = std::round(columns - turn * std::round(columns / turn));
  const double west = source.geotransform[0] + near * source.geotransform[1];
  const double east = west + count * source.geotransform[1];
  const bool ordinary = west >= -180 - source.geotransform[1] && east <= 360 + source.geotransform[1];
  return ordinary ? near : std::round(columns);
}

// The same in the words of the first source, as far as it goes: its own numbers, moved by whole posts.
std::array<double, 6> geotransformLike(const SourceDescription& source, const GridHeader& header) {
  std::array<double, 6> transform = source.geotransform;
  const std::array<double, 6> exact = geotransformOf(header);
  const bool south_up = transform[5] > 0;
  const double rows = static_cast<double>(header.y_axis.count);
  const double first_row = south_up ? exact[3] + rows * exact[5] : exact[3];
  const double columns_off = turnLike(source, header, (exact[0] - transform[0]) / transform[1]);
  transform[0] += columns_off * transform[1];
  transform[3] += std::round((first_row - transform[3]) / transform[5]) * transform[5];
  return transform;
}

// How a grid is stored in the file.
struct Storage {
  SourceDescription like;  // scale, offset, unit, nodata
  StoredType type;
  Rational unit;  // metres
  std::array<double, 6> geotransform{};
  bool one_sentinel = false;  // all voids are written as like.nodata
};

// The smallest type of whole numbers that holds those of all sources; the type itself if they agree.
std::string commonType(const std::vector<SourceDescription>& sources) {
  const std::string& first = sources.front().data_type;
  double lowest = 0, highest = 0;
  bool same = true;
  for (const SourceDescription& source : sources) {
    same = same && source.data_type == first;
    const StoredType type = storedTypeOf(source.data_type).value_or(StoredType{});
    lowest = std::min(lowest, type.lowest);
    highest = std::max(highest, type.highest);
  }
  if (same) return first;
  for (const char* const name : {"Int16", "UInt16", "Int32", "UInt32", "Int64"}) {
    const StoredType type = *storedTypeOf(name);
    if (type.lowest <= lowest && type.highest >= highest) return name;
  }
  return "Float64";
}

Result<Storage> storageOf(const RawGrid& grid, int level, const std::string& target) {
  const GridHeader& header = grid.header;
  Storage storage;
  storage.geotransform = geotransformOf(header);
  if (header.sources.empty() || header.resampling) {
    // No source has these posts: metres, in a type that holds them.
    storage.like.data_type = header.resampling ? "Float32" : "Int32";
    storage.like.unit = "m";
    if (!header.sentinels.empty()) storage.like.nodata = header.sentinels.front();
  } else {
    storage.like = header.sources.front();
    storage.like.data_type = commonType(header.sources);
    storage.one_sentinel = header.sources.size() > 1;
    if (level == 0) storage.geotransform = geotransformLike(storage.like, header);
    if (storage.one_sentinel && !storage.like.nodata && !header.sentinels.empty())
      storage.like.nodata = header.sentinels.front();
  }
  if (!storage.like.nodata && header.sentinels.empty() && !grid.valid.empty())
    storage.like.nodata = kDefaultNodata;
  const std::optional<StoredType> type = storedTypeOf(storage.like.data_type);
  if (!type) {
    return invalidError(IssueCode::kManField, target,
                        fmt::format("'{}' is no type of elevations", storage.like.data_type),
                        "area.json names it as its source's");
  }
  storage.type = *type;
  std::string unit = storage.like.unit;
  if (unit.empty()) {
    if (const auto system = parseReferenceSystem(header.crs_wkt, target); system.ok())
      unit = system.value().vertical_unit;
  }
  const std::optional<Rational> metres = metresPerUnit(unit);
  if (!metres) {
    return invalidError(IssueCode::kManField, target, fmt::format("the elevation unit '{}' is unknown", unit),
                        "area.json names it as its source's");
  }
  storage.unit = *metres;
  return storage;
}

Result<double> voidValue(const RawGrid& grid, const Storage& storage, std::size_t post,
                         const std::string& target) {
  const std::vector<double>& sentinels = grid.header.sentinels;
  const std::size_t kind = grid.void_kinds.empty() ? 0 : grid.void_kinds[post];
  if (!storage.one_sentinel && kind < sentinels.size()) return sentinels[kind];
  if (storage.like.nodata) return *storage.like.nodata;
  return invalidError(IssueCode::kHgtDecode, target, fmt::format("a void is of kind {}", kind),
                      "the grid has no such sentinel");
}

bool setNodata(GDALRasterBand& band, double nodata) {
  if (band.GetRasterDataType() == GDT_Int64)
    return band.SetNoDataValueAsInt64(static_cast<std::int64_t>(nodata)) == CE_None;
  if (band.GetRasterDataType() == GDT_UInt64)
    return band.SetNoDataValueAsUInt64(static_cast<std::uint64_t>(nodata)) == CE_None;
  return band.SetNoDataValue(nodata) == CE_None;
}

Status writeRaster(const RawGrid& grid, int level, const std::string& path, const std::string& target,
                   const GdalSession& session) {
  const GridHeader& header = grid.header;
  DELTAZ_TRY_ASSIGN(Storage storage, storageOf(grid, level, target));
  const SourceDescription& like = storage.like;
  GDALDriver* driver = GetGDALDriverManager()->GetDriverByName("GTiff");
  if (driver == nullptr) return internalError(target, "GDAL has no GeoTIFF driver");
  const GDALDataType type = GDALGetDataTypeByName(like.data_type.c_str());
  const int columns = static_cast<int>(header.x_axis.count);
  const int rows = static_cast<int>(header.y_axis.count);
  CPLStringList creation;
  creation.SetNameValue("COMPRESS", "DEFLATE");
  creation.SetNameValue("PREDICTOR", storage.type.floating ? "3" : "2");
  creation.SetNameValue("BIGTIFF", "IF_SAFER");
  GDALDatasetUniquePtr dataset(driver->Create(path.c_str(), columns, rows, 1, type, creation.List()));
  if (!dataset) return accessError(target, "cannot create the file", session.lastFailure());

  const bool south_up = storage.geotransform[5] > 0;
  OGRSpatialReference reference;
  reference.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  bool failed = reference.importFromWkt(header.crs_wkt.c_str()) != OGRERR_NONE;
  if (header.coordinate_epoch) reference.SetCoordinateEpoch(*header.coordinate_epoch);
  failed = failed || dataset->SetSpatialRef(&reference) != CE_None;
  failed = failed || dataset->SetGeoTransform(storage.geotransform.data()) != CE_None;
  failed = failed ||
           dataset->SetMetadataItem(GDALMD_AREA_OR_POINT,
                                    like.point_registered ? GDALMD_AOP_POINT : GDALMD_AOP_AREA) != CE_None;
  GDALRasterBand& band = *dataset->GetRasterBand(1);
  if (like.nodata) failed = failed || !setNodata(band, *like.nodata);
  if (!like.unit.empty()) failed = failed || band.SetUnitType(like.unit.c_str()) != CE_None;
  if (like.scale != 1) failed = failed || band.SetScale(like.scale) != CE_None;
  if (like.offset != 0) failed = failed || band.SetOffset(like.offset) != CE_None;

  const StoredValues stored(like, storage.type, storage.unit, header.quantum);
  std::vector<double> line(static_cast<std::size_t>(columns));
  for (int row = 0; row < rows && !failed; ++row) {
    for (int column = 0; column < columns; ++column) {
      double& value = line[static_cast<std::size_t>(column)];
      if (grid.isValid(column, row)) {
        value = stored.storedOf(static_cast<double>(grid.height(column, row)));
        continue;
      }
      const auto post = static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) +
                        static_cast<std::size_t>(column);
      DELTAZ_TRY_ASSIGN(value, voidValue(grid, storage, post, target));
    }
    const int target_row = south_up ? row : rows - 1 - row;
    failed = band.RasterIO(GF_Write, 0, target_row, columns, 1, line.data(), columns, 1, GDT_Float64, 0, 0,
                           nullptr) != CE_None;
  }
  // A full disk may show only when the last blocks are written.
  dataset.reset();
  if (failed || session.hasFailed())
    return accessError(target, "cannot write the file", session.lastFailure());
  return Success{};
}

// Of writing: about the file that was asked for. GDAL's own words have the temporary name in them.
Error aboutTarget(Error error, const std::string& temporary, const std::string& target) {
  error.where = target;
  for (std::size_t at = error.why.find(temporary); at != std::string::npos;
       at = error.why.find(temporary, at + target.size()))
    error.why.replace(at, temporary.size(), target);
  return error;
}

}  // namespace

Result<RawGrid> readGrid(const Database& database, int grid_number, int level) {
  if (grid_number < 0 || grid_number >= database.gridCount()) {
    return usageError("--grid", fmt::format("there is no grid {}", grid_number),
                      fmt::format("the database has {}, counted from 0", database.gridCount()));
  }
  const GridGeometry& geometry = database.grid(grid_number);
  if (level < 0 || level >= geometry.header().level_count) {
    return usageError(
        "--level", fmt::format("there is no level {}", level),
        fmt::format("the grid has {}, counted from 0, the finest", geometry.header().level_count));
  }
  const PostRange columns = geometry.columnsAt(level);
  const PostRange rows = geometry.rowsAt(level);
  if (columns.size() < 1 || rows.size() < 1)
    return usageError("--level", fmt::format("level {} holds no post", level));
  RawGrid grid;
  grid.header = geometry.header();
  if (level > 0) {
    grid.header.x_axis = axisAt(grid.header.x_axis, columns, level);
    grid.header.y_axis = axisAt(grid.header.y_axis, rows, level);
  }
  DELTAZ_TRY_ASSIGN(const std::vector<Node> nodes, nodesOfLevel(database, grid_number, level));
  // A damaged header must not make us ask for more memory than the nodes could fill.
  const std::int64_t posts_per_node =
      std::int64_t{geometry.header().leaf_cells + 1} * (geometry.header().leaf_cells + 1);
  if (columns.size() > static_cast<std::int64_t>(nodes.size()) * posts_per_node / rows.size()) {
    return invalidError(IssueCode::kRefUnreachable, database.path(),
                        fmt::format("level {} does not cover the area", level));
  }
  grid.heights.assign(static_cast<std::size_t>(columns.size() * rows.size()), 0);
  std::vector<std::uint8_t> valid(grid.heights.size(), 0);
  std::vector<std::uint8_t> kinds;
  std::uint64_t posts = 0;
  for (const Node& node : nodes) {
    DELTAZ_TRY_ASSIGN(const TerrainTile tile, database.terrain(node));
    for (int j = 0; j < tile.rows; ++j) {
      const std::int64_t row = tile.first_row + j - rows.begin;
      for (int i = 0; i < tile.columns; ++i) {
        const auto at =
            static_cast<std::size_t>(row * columns.size() + tile.first_column + i - columns.begin);
        grid.heights[at] = tile.height(i, j);
        valid[at] = tile.isValid(i, j) ? 1 : 0;
        if (!tile.void_kinds.empty() && tile.void_kinds[tile.index(i, j)] != 0) {
          if (kinds.empty()) kinds.assign(grid.heights.size(), 0);
          kinds[at] = tile.void_kinds[tile.index(i, j)];
        }
        ++posts;
      }
    }
  }
  // Posts on shared borders come more than once, so fewer posts than the area has means a missing node.
  if (posts < grid.heights.size()) {
    return invalidError(IssueCode::kRefUnreachable, database.path(),
                        fmt::format("level {} does not cover the area", level));
  }
  if (std::find(valid.begin(), valid.end(), std::uint8_t{0}) != valid.end()) grid.valid = std::move(valid);
  grid.void_kinds = std::move(kinds);
  grid.patches = level == 0 ? geometry.patches() : nullptr;
  return grid;
}

Status exportTerrain(const Database& database, const std::string& target, const ExportOptions& options) {
  const FileSystem& files = localFileSystem();
  DELTAZ_TRY_ASSIGN(const PathType type, files.typeOf(target));
  if (type == PathType::kDirectory) return usageError(target, "the target is a folder", {}, "Name a file");
  if (type == PathType::kOther)
    return usageError(target, "the target is not a regular file", {}, "Choose another name");
  if (type != PathType::kAbsent && !options.overwrite) {
    return usageError(target, "the target exists", {}, "Choose another name or give --overwrite");
  }
  DELTAZ_TRY_ASSIGN(const PathType parent, files.typeOf(parentPath(target)));
  if (parent != PathType::kDirectory)
    return accessError(parentPath(target), "cannot write here", "there is no such folder", "Make it first");
  DELTAZ_TRY_ASSIGN(RawGrid grid, readGrid(database, options.grid, options.level));
  // The import repeats the first column of a grid that goes round the Earth: no source has it.
  if (options.level == 0 && hasRepeatedColumn(grid.header)) {
    cutTo(grid, {0, grid.header.x_axis.count - 1, 0, grid.header.y_axis.count});
  }

  const std::string temporary =
      joinPath(parentPath(target), fmt::format(".{}.tmp-{}", baseName(target), ::getpid()));
  try {
    Status written = Success{};
    {
      const GdalSession session;
      written = writeRaster(grid, options.level, temporary, target, session);
    }
    if (written.ok()) written = files.syncFile(temporary);
    if (written.ok()) {
      written =
          options.overwrite ? files.rename(temporary, target) : files.renameNoReplace(temporary, target);
    }
    if (!written.ok()) {
      (void)files.removeFile(temporary);
      return aboutTarget(written.error(), temporary, target);
    }
    return files.syncDirectory(parentPath(target));
  } catch (const std::exception& exception) {
    (void)files.removeFile(temporary);
    return internalError(target, exception.what());
  }
}

}  // namespace deltaz
