// The resolver: depth/frame buffer -> picture. Every visible sample is shaded once, terrain with the colour
// map where it has cover; the sea is put in where it is nearer, the sky where there is nothing; haze over all
// of it, sRGB at the end.
//
// Runs on the threads of the caller's TBB arena.
#pragma once

#include <cstdint>
#include <vector>

#include "librender/raster/tiler.h"
#include "librender/scene/environment.h"
#include "librender/scene/texture_store.h"

namespace deltaz {

struct ResolverStatistics {
  std::uint64_t covered = 0;  // pixels on which some face was drawn
  std::uint64_t shaded = 0;   // of these, the ones where it is seen
};

// What the pixels of terrain that are seen need of the environment's colour map; each once, in order.
std::vector<TextureSquare> visibleSquares(const Environment& environment, const TiledFrame& frame);

// `textures` holds at least what visibleSquares asks for.
ResolverStatistics resolve(const Environment& environment, const TiledFrame& frame,
                           const TextureStore& textures, Picture& picture);

}  // namespace deltaz
