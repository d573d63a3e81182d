// The resolver: depth/frame buffer -> picture. Every visible sample is shaded once (sample_shader.h), sRGB at
// the end.
//
// Runs on the threads of the caller's TBB arena.
#pragma once

#include <cstdint>
#include <span>

#include "librender/raster/tiler.h"
#include "librender/scene/environment.h"
#include "librender/scene/texture_store.h"

namespace deltaz {

struct ResolverStatistics {
  std::uint64_t covered = 0;  // pixels on which some face was drawn
  std::uint64_t shaded = 0;   // of these, the ones where it is seen
};

// `nodes` are those the frame was made of. Tiles of the colour map are read into `textures` as they are
// needed: see TextureStore::status.
ResolverStatistics resolve(const Environment& environment, const TiledFrame& frame,
                           std::span<const PretiledNode> nodes, TextureStore& textures, Picture& picture);

}  // namespace deltaz
