#include "tests/support/furnished_area.h"

#include <stdexcept>
#include <utility>

#include "libdb/access/ground_query.h"
#include "tests/support/model_fixture.h"
#include "tests/support/synthetic_grid.h"

namespace deltaz {

RawGrid furnishedGrid() {
  SyntheticGridOptions options;
  options.columns = 21;
  options.rows = 19;
  options.voids = VoidPattern::kSingle;
  return syntheticGrid(options);
}

ColorFunction furnishedColors() {
  const GridHeader header = furnishedGrid().header;
  const auto last = static_cast<double>(header.x_axis.first + header.x_axis.count - 4);
  const auto first = static_cast<double>(header.y_axis.first);
  return [last, first](std::uint16_t, double column, double row) {
    if (column > last) return std::array<std::uint8_t, 4>{};
    if (row - first < last - column) return std::array<std::uint8_t, 4>{196, 180, 90, 255};
    return std::array<std::uint8_t, 4>{40, 90, 30, 255};
  };
}

const MemoryFileSystem& furnishedArea() {
  static const MemoryFileSystem files = [] {
    BuildOptions options;
    options.leaf_cells = 8;
    MemoryFileSystem made = buildInMemory(furnishedGrid(), options);
    addColorMapOf(made, kMemoryDatabasePath, "summer", kFurnishedColorLevel, furnishedColors());
    addFixtureModel(made, kMemoryDatabasePath);
    const Result<Database> database = Database::open(made, kMemoryDatabasePath);
    if (!database.ok()) throw std::runtime_error(database.error().message());
    std::vector<Placement> placements;
    for (const auto& [latitude, longitude] : {std::pair(43.02, -79.98), {43.11, -79.86}, {43.05, -79.92}}) {
      const auto ground = groundHeight(database.value(), latitude, longitude);
      if (!ground.ok() || !ground.value()) throw std::runtime_error("no ground under a tower");
      placements.push_back(placementAt(latitude, longitude, *ground.value(), 30));
    }
    placements[0].on_ground = placements[1].on_ground = true;
    placements[1].above_ground = 12;
    placements[1].height += 12;
    placements[2].height += 500;
    setPlacements(made, kMemoryDatabasePath, placements);
    return made;
  }();
  return files;
}

}  // namespace deltaz
