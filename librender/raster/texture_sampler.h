// Trilinear interpolation of a colour map (report 6.4).
//
// D is the size of a pixel in texels. Between the two levels with D of the finer in [1, 2) the result is
// linear in D: t = D - 1 of the coarser. Within a level it is bilinear between texel centres, which lie at
// (index + 0.5) texels. Below the finest and above the coarsest level of the map that level is taken alone;
// where the map lacks a level, the next coarser one serves. All in linear light, premultiplied by cover.
// Thread-safety: pure functions, but for the reader, which belongs to one thread.
#pragma once

#include <optional>

#include "libdb/access/color.h"
#include "librender/raster/texture_planes.h"
#include "librender/scene/texture_store.h"

namespace deltaz {

struct MipLevels {
  int level = 0;  // the finer one
  double t = 0;   // of the next coarser level, 0 <= t < 1
};

// `pixel_size` in level-0 cells, as of TextureFootprint::size.
MipLevels mipLevels(double pixel_size, int leaf_cells, const ColorTree& tree);

// What a footprint needs of a map.
struct TextureRequest {
  GridCoordinates place;
  TextureSquare fine, coarse;
  double t = 0;  // of the coarse one; if 0 only the fine one is needed
};

// Nothing where the map has no texels for this grid or the place is not known.
std::optional<TextureRequest> textureRequest(const ColorMap& map, std::uint16_t grid,
                                             const TextureFootprint& footprint);

struct TextureSample {
  LinearColor color;  // times cover
  double cover = 0;   // 0 .. 1
};

TextureSample bilinearSample(const TextureTile& tile, const GridCoordinates& place);
TextureSample trilinearSample(TextureReader& reader, const TextureRequest& request);

}  // namespace deltaz
