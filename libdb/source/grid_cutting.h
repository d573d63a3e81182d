// Cuts a grid down to geographic bounds: to the posts inside, and outwards to the next post. Pure function.
#pragma once

#include "formats/error.h"
#include "libdb/source/elevation_source.h"
#include "libdb/source/reference_system.h"

namespace deltaz {

// Posts that remain of a grid; count 0 if none.
struct PostWindow {
  std::int64_t first_column = 0, columns = 0, first_row = 0, rows = 0;
};

// `bounds` are latitudes and longitudes of `area`, `system` is what the grid's axes refer to.
Result<PostWindow> windowWithin(const GridHeader& header, const ReferenceSystem& system,
                                const ReferenceSystem& area, const SourceBounds& bounds, bool allow_ballpark,
                                const std::string& path);

// Pre: the window lies in the grid and holds 2 x 2 posts at least.
void cutTo(RawGrid& grid, const PostWindow& window);

}  // namespace deltaz
