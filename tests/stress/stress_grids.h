// Grids and tiles at the edges of what a database may hold.
#pragma once

#include <ostream>
#include <string>
#include <vector>

#include "libdb/access/grid_geometry.h"
#include "libdb/access/terrain_tile.h"
#include "libdb/source/elevation_source.h"
#include "tests/support/synthetic_grid.h"

namespace deltaz {

struct NamedGrid {
  std::string name;  // letters, digits and underscores
  RawGrid grid;
  int leaf_cells = 16;
};

// For messages of GoogleTest.
inline void PrintTo(const NamedGrid& named, std::ostream* out) {
  *out << named.name;
}

// Poles, antimeridian, long thin grids, least spacing, extreme ellipsoids and quanta, voids.
std::vector<NamedGrid> extremeGrids();

// An axis whose spacing is no fraction of an arc-second: posts `spacing` apart from the multiple at or before
// `first` on.
void setPlainAxis(GridAxis& axis, const AxisOrigin& origin, double first, double spacing, std::int64_t count);

// All posts of a grid as one tile of level 0, with a void ring.
TerrainTile wholeTile(const RawGrid& grid);

// Columns [first, first + columns) of a tile as a tile of its own, its ring from the tile.
TerrainTile columnsOf(const TerrainTile& tile, int first, int columns);

// 33 x 33 posts 3 arc-seconds apart, of two heights that change from post to post.
RawGrid alternatingGrid(std::int32_t height, Rational quantum);

// A projected grid of columns x rows posts `spacing` metres apart near latitude 46 north, placed by a lattice
// of control points on the ellipsoid's surface.
RawGrid projectedGrid(std::int64_t columns, std::int64_t rows, double spacing);

// An ordinary country, for what is harmed by the host and not by the grid.
NamedGrid hills();

}  // namespace deltaz
