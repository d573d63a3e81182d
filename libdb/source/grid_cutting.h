// Cuts a grid down to geographic bounds: to the posts inside, and outwards to the next post. Pure function.
#pragma once

#include <vector>

#include "formats/error.h"
#include "libdb/source/elevation_source.h"
#include "libdb/source/reference_system.h"

namespace deltaz {

// Posts that remain of a grid. Columns of a grid that goes round the Earth may run on past its last one.
struct PostWindow {
  std::int64_t first_column = 0, columns = 0, first_row = 0, rows = 0;
};

// `bounds` are latitudes and longitudes of `area`, `system` is what the grid's axes refer to. From west to
// east; empty if no post remains, and more than one window where the bounds reach from the grid's east side
// over ground it does not have to its west side.
Result<std::vector<PostWindow>> windowsWithin(const GridHeader& header, const ReferenceSystem& system,
                                              const ReferenceSystem& area, const SourceBounds& bounds,
                                              bool allow_ballpark, const std::string& path);

// Pre: the window is one of the grid's own, and holds 2 x 2 posts at least.
void cutTo(RawGrid& grid, const PostWindow& window);

}  // namespace deltaz
