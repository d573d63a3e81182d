#include "tests/librender/textured_area.h"

#include <stdexcept>

#include "libdb/build/build_terrain.h"

namespace deltaz {

MemoryDatabase makeTexturedDatabase(const std::vector<RawGrid>& grids, int leaf_cells, int finest_level,
                                    const ColorFunction& color) {
  BuildOptions options;
  options.leaf_cells = leaf_cells;
  MemoryFileSystem files;
  (void)files.makeDirectory("/folder");
  const Result<BuildSummary> built = buildTerrain(files, grids, kMemoryDatabasePath, options);
  if (!built.ok()) throw std::runtime_error(built.error().message());
  addColorMapOf(files, kMemoryDatabasePath, kTestColorMap, finest_level, color);
  Result<Database> database = Database::open(files, kMemoryDatabasePath);
  if (!database.ok()) throw std::runtime_error(database.error().message());
  return {std::move(files), std::move(database).value()};
}

}  // namespace deltaz
