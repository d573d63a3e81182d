#include "tests/librender/test_databases.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <stdexcept>

#include "libdb/access/ground_query.h"
#include "libdb/source/elevation_source.h"

namespace deltaz {

MemoryDatabase makeDatabaseOf(const RawGrid& grid, int leaf_cells) {
  BuildOptions options;
  options.leaf_cells = leaf_cells;
  MemoryFileSystem files = buildInMemory(grid, options);
  Result<Database> database = Database::open(files, kMemoryDatabasePath);
  if (!database.ok()) throw std::runtime_error(database.error().message());
  return {std::move(files), std::move(database).value()};
}

MemoryDatabase makeDatabase(const SyntheticGridOptions& options, int leaf_cells) {
  return makeDatabaseOf(syntheticGrid(options), leaf_cells);
}

std::optional<MemoryDatabase> databaseOfFile(const std::string& path) {
  std::FILE* file = std::fopen(path.c_str(), "rb");
  if (file == nullptr) return std::nullopt;
  std::fclose(file);
  Result<RawGrid> grid = readElevationSource(path, {});
  if (!grid.ok()) throw std::runtime_error(grid.error().message());
  return makeDatabaseOf(grid.value(), 64);
}

Picture draw(EngineKind kind, const Database& database, const RenderOptions& options,
             FrameStatistics& statistics) {
  Result<Picture> picture = makeEngine(kind)->render(database, options, statistics);
  if (!picture.ok()) throw std::runtime_error(picture.error().message());
  return std::move(picture).value();
}

Picture draw(EngineKind kind, const Database& database, const RenderOptions& options) {
  FrameStatistics statistics;
  return draw(kind, database, options, statistics);
}

Camera cameraOver(const Database& database, double x, double y, double above, double heading, double pitch,
                  int width, int height) {
  const AreaHeader& area = database.area();
  Camera camera;
  camera.eye.latitude = area.south + (area.north - area.south) * y;
  camera.eye.longitude = area.west + (area.east - area.west) * x;
  const Result<std::optional<double>> ground =
      groundHeight(database, camera.eye.latitude, camera.eye.longitude);
  const bool known = ground.ok() && ground.value().has_value();
  camera.eye.height = (known ? *ground.value() : area.highest_height) + above;
  camera.heading = heading;
  camera.pitch = pitch;
  camera.width = width;
  camera.height = height;
  return camera;
}

RawGrid countryOfTwoErrors(std::int32_t rise) {
  SyntheticGridOptions options = smallArea();
  options.west = -122;
  options.columns = 129;
  options.rows = 65;
  RawGrid grid = syntheticGrid(options);
  const auto at = [&](std::int64_t column, std::int64_t row) -> std::int32_t& {
    return grid.heights[static_cast<std::size_t>(row * options.columns + column)];
  };
  std::fill(grid.heights.begin(), grid.heights.end(), 500);
  constexpr std::int64_t kLine = 64;
  for (std::int64_t step = 4; step > 0; step /= 2) {
    for (std::int64_t row = 0; row < options.rows; row += step) {
      for (std::int64_t column = 0; column < options.columns; column += step) {
        const std::int64_t dx = column % (2 * step), dy = row % (2 * step);
        if (dx == 0 && dy == 0) continue;
        const std::int32_t middle = (at(column - dx, row - dy) + at(column + dx, row + dy)) / 2;
        const std::int32_t in_west = step == 2 ? rise : step == 4 && column < kLine ? 400 : 0;
        const std::int32_t in_east = step == 1 ? rise : step == 2 ? 400 : 0;
        at(column, row) = middle + (column <= kLine ? in_west : in_east);
      }
    }
  }
  return grid;
}

}  // namespace deltaz
