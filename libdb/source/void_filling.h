// Gives void posts heights between those of their neighbours: a membrane stretched over the void, found on a
// pyramid of averages, so that a void of any size costs the same a post. Pure function; memory: about eleven
// bytes a post beside the grid.
#pragma once

#include <cstdint>

#include "libdb/source/elevation_source.h"

namespace deltaz {

// Fills all voids of a grid that has some height; returns how many there were. Heights that were there stay.
std::uint64_t fillVoidPosts(RawGrid& grid);

}  // namespace deltaz
