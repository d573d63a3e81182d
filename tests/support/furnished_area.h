// A small database with everything in it: terrain, a colour map, a model and its placements.
#pragma once

#include "libdb/source/elevation_source.h"
#include "tests/support/color_map_fixture.h"
#include "tests/support/memory_file_system.h"

namespace deltaz {

inline constexpr int kFurnishedColorLevel = 1;  // of the map's finest nodes

// The source of its terrain: 21 x 19 posts of 30 arc-seconds from 43 N, 80 W on, leaves of 8 cells.
RawGrid furnishedGrid();
// The colours of its map, "summer": two fields, and no cover east of the last post but three.
ColorFunction furnishedColors();

// At kMemoryDatabasePath. Towers (tests/support/model_fixture.h) stand on the ground, above it, and at a
// height of their own.
const MemoryFileSystem& furnishedArea();

}  // namespace deltaz
