#include "tests/librender/textured_area.h"

#include <stdexcept>

#include "libdb/build/build_terrain.h"
#include "tests/support/projected_grid.h"

namespace deltaz {

std::vector<RawGrid> insetBetweenPosts() {
  SyntheticGridOptions inset = smallArea();
  inset.seed = 2;
  inset.south = 46.8 + 100.5 / 3600;
  inset.west = -121.8 + 95.25 / 3600;
  inset.spacing_latitude = inset.spacing_longitude = {4, 5};
  inset.columns = 150;
  inset.rows = 131;
  return {syntheticGrid(inset), syntheticGrid(smallArea())};
}

std::vector<RawGrid> projectedInset() {
  ProjectedGridOptions utm;
  utm.columns = 131;
  utm.rows = 113;
  utm.spacing = 20;
  utm.zone = 10;
  utm.easting = 593000;
  utm.northing = 5188000;
  return {projectedGrid(utm), syntheticGrid(smallArea())};
}

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
