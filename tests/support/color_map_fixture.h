// Colour maps whose colours are a given function of the place, built by the product's own pyramid.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <string>

#include "formats/file_system.h"

namespace deltaz {

// Red, green, blue (sRGB codes) and cover at (column, row), level-0 posts of a grid; called from several
// threads.
using ColorFunction =
    std::function<std::array<std::uint8_t, 4>(std::uint16_t grid, double column, double row)>;

// Adds a colour map to the database at `path`: texels of level `finest_level` (see formats/color_file.h) are
// the function's values at their centres over the grid and a margin around it, coarser ones their means,
// borders the neighbours' texels. Throws std::runtime_error.
void addColorMapOf(const FileSystem& files, const std::string& path, const std::string& name,
                   int finest_level, const ColorFunction& color);

// The same through a level for each grid.
void addColorMapOf(const FileSystem& files, const std::string& path, const std::string& name,
                   const std::function<int(std::uint16_t grid)>& finest_level, const ColorFunction& color);

}  // namespace deltaz
