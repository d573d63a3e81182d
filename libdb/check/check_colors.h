// The rules of colour maps. Internal to libdb/check.
#pragma once

#include <vector>

#include "formats/color_file.h"

namespace deltaz {

struct CheckContext;
struct CheckedFile;

// A colour map whose file could be opened. Memory: 24 bytes a node.
struct CheckedColorMap {
  CheckedFile* file = nullptr;
  ColorDirectory directory;
  std::vector<ColorNode> nodes;  // record n is nodes[n - 1]
  // Every record is there, and stands once where its parent says.
  bool tree_sound = false;
};

// COL_TREE; fills CheckContext::color_maps.
void checkColorTrees(CheckContext& context);
// COL_TILE, COL_BORDER, COL_FILTER.
void checkColorTiles(CheckContext& context);

}  // namespace deltaz
