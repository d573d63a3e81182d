// Gives void posts heights between those of their neighbours: a membrane stretched over the void, found on a
// pyramid of averages, so that a void of any size costs the same a post. Pure function; memory: about eleven
// bytes a post beside the grid.
#pragma once

#include <cstdint>
#include <span>

#include "libdb/source/elevation_source.h"

namespace deltaz {

// Fills the voids of a grid that has some height; returns how many were filled. Heights that were there stay.
// `covered` is empty, or 1 where other grids have a surface (void_cover.h): a void stays where that is so all
// around it, so that what is filled reaches no more than a post over them, there at their height.
std::uint64_t fillVoidPosts(RawGrid& grid, std::span<const std::uint8_t> covered = {});

}  // namespace deltaz
