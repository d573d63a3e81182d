// Grids whose columns go all the way round the Earth: their first meridian is also their last. Pure
// functions.
#pragma once

#include <cstdint>

#include "libdb/source/elevation_source.h"

namespace deltaz {

// Columns in a full turn of longitude, 0 if that is no whole number or the columns have no longitudes.
std::int64_t columnsInTurn(const GridHeader& header);

// Columns in a full turn if the grid has them all, else 0.
std::int64_t fullTurn(const GridHeader& header);

// A grid with each meridian once leaves a slit between its last column and its first: the first is repeated
// at the end, as sources with posts at -180 and 180 have it themselves.
void closeTurn(RawGrid& grid);

// Whether a grid's last column is such a repetition, which no source of it has. Never of a resampled grid.
bool hasRepeatedColumn(const GridHeader& header);

}  // namespace deltaz
