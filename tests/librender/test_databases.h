// Databases for the tests that draw.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "libdb/access/database.h"
#include "librender/scene/render.h"
#include "tests/support/memory_file_system.h"
#include "tests/support/small_area.h"

namespace deltaz {

// A database in memory and the file system that holds it.
struct MemoryDatabase {
  MemoryFileSystem files;
  Database database;
};

// Throws std::runtime_error if it cannot be built or opened.
MemoryDatabase makeDatabase(const SyntheticGridOptions& options, int leaf_cells = 16);
MemoryDatabase makeDatabaseOf(const RawGrid& grid, int leaf_cells);
// Of a DEM file; nothing if there is no such file.
std::optional<MemoryDatabase> databaseOfFile(const std::string& path);

// Draws; throws std::runtime_error on an error.
Picture draw(EngineKind kind, const Database& database, const RenderOptions& options,
             FrameStatistics& statistics);
Picture draw(EngineKind kind, const Database& database, const RenderOptions& options);

// Country where both errors meet. Every post is the middle of an edge of the next coarser level, plus a rise:
// in the west, up to and on the line between two coarse nodes, `rise` on the posts that level 1 adds, so that
// level 2 is good enough; in the east on those that level 0 adds, so that level 1 is. Rises of 400 keep
// either from being drawn coarser. Beside the line the east's faces err by their own error and by half of
// what the line moved.
RawGrid countryOfTwoErrors(std::int32_t rise);

// A camera `above` metres over the ground at a fraction (x, y) of the area, looking along heading and pitch.
Camera cameraOver(const Database& database, double x, double y, double above, double heading, double pitch,
                  int width, int height);

}  // namespace deltaz
