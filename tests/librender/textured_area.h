// Databases with a colour map given by a function, for the tests that draw them.
#pragma once

#include <string>
#include <vector>

#include "tests/librender/test_databases.h"
#include "tests/support/color_map_fixture.h"

namespace deltaz {

inline const std::string kTestColorMap = "summer";

// Two grids that overlap, the one on top first: an inset with posts between the country's, and one in UTM.
std::vector<RawGrid> insetBetweenPosts();
std::vector<RawGrid> projectedInset();

// A database in memory of `grids`, the one on top first, with the colour map kTestColorMap.
MemoryDatabase makeTexturedDatabase(const std::vector<RawGrid>& grids, int leaf_cells, int finest_level,
                                    const ColorFunction& color);

}  // namespace deltaz
