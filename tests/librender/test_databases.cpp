#include "tests/librender/test_databases.h"

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

}  // namespace deltaz
