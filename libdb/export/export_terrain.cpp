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
#include "libdb/source/gdal_session.h"

namespace deltaz {

namespace {

// Used where a coarser level has voids and the source declared no sentinel.
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

std::array<double, 6> geotransformOf(const GridHeader& header) {
  const double west = postCoordinate(header.x_axis, kLongitudeOrigin, header.x_axis.first);
  const double north = postCoordinate(header.y_axis, kLatitudeOrigin, header.y_axis.first + header.y_axis.count - 1);
  return {west - 0.5 * header.x_axis.spacing,
          header.x_axis.spacing,
          0,
          north + 0.5 * header.y_axis.spacing,
          0,
          -header.y_axis.spacing};
}

Status writeRaster(const RawGrid& grid, int level, const std::string& path, const std::string& target,
                   const GdalSession& session) {
  const GridHeader& header = grid.header;
  const SourceDescription source = header.sources.empty() ? SourceDescription{} : header.sources.front();
  GDALDriver* driver = GetGDALDriverManager()->GetDriverByName("GTiff");
  if (driver == nullptr) return internalError(target, "GDAL has no GeoTIFF driver");
  GDALDataType type = GDALGetDataTypeByName(source.data_type.c_str());
  if (type == GDT_Unknown) type = GDT_Int32;
  const int columns = static_cast<int>(header.x_axis.count);
  const int rows = static_cast<int>(header.y_axis.count);
  CPLStringList creation;
  creation.SetNameValue("COMPRESS", "DEFLATE");
  creation.SetNameValue("PREDICTOR", "2");
  GDALDatasetUniquePtr dataset(driver->Create(path.c_str(), columns, rows, 1, type, creation.List()));
  if (!dataset) return accessError(target, "cannot create the file", session.lastFailure());

  std::array<double, 6> transform =
      level == 0 && !header.sources.empty() ? source.geotransform : geotransformOf(header);
  const bool south_up = transform[5] > 0;
  OGRSpatialReference reference;
  reference.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  bool failed = reference.importFromWkt(header.crs_wkt.c_str()) != OGRERR_NONE;
  if (header.coordinate_epoch) reference.SetCoordinateEpoch(*header.coordinate_epoch);
  failed = failed || dataset->SetSpatialRef(&reference) != CE_None;
  failed = failed || dataset->SetGeoTransform(transform.data()) != CE_None;
  failed = failed ||
           dataset->SetMetadataItem(GDALMD_AREA_OR_POINT,
                                    source.point_registered ? GDALMD_AOP_POINT : GDALMD_AOP_AREA) != CE_None;
  GDALRasterBand& band = *dataset->GetRasterBand(1);
  const double nodata = source.nodata.value_or(kDefaultNodata);
  if (source.nodata || !grid.valid.empty()) failed = failed || band.SetNoDataValue(nodata) != CE_None;
  if (!source.unit.empty()) failed = failed || band.SetUnitType(source.unit.c_str()) != CE_None;

  std::vector<std::int32_t> line(static_cast<std::size_t>(columns));
  for (int row = 0; row < rows && !failed; ++row) {
    for (int column = 0; column < columns; ++column) {
      line[static_cast<std::size_t>(column)] =
          grid.isValid(column, row) ? grid.height(column, row) : static_cast<std::int32_t>(nodata);
    }
    const int target_row = south_up ? row : rows - 1 - row;
    failed = band.RasterIO(GF_Write, 0, target_row, columns, 1, line.data(), columns, 1, GDT_Int32, 0, 0,
                           nullptr) != CE_None;
  }
  // A full disk may show only when the last blocks are written.
  dataset.reset();
  if (failed || session.hasFailed())
    return accessError(target, "cannot write the file", session.lastFailure());
  return Success{};
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
  DELTAZ_TRY_ASSIGN(const RawGrid grid, readGrid(database, options.grid, options.level));

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
      return written;
    }
    return files.syncDirectory(parentPath(target));
  } catch (const std::exception& exception) {
    (void)files.removeFile(temporary);
    return internalError(target, exception.what());
  }
}

}  // namespace deltaz
