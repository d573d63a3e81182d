// The resolver where pixels have several samples, or take those of their neighbours: what is seen on the
// sample grid -> picture.
//
// A pixel is shaded once for each thing its samples show (a face, the sea, the sky), at the mean place of the
// samples that show it: the pixel's centre where all of them do, inside the face in any case. What a sample
// shows is settled by itself, where the sea comes before a face too. The colours are weighted by the filter
// in linear light (filter.h). Textures are taken as large as the pixel, not the sample.
//
// The picture does not depend on threads or vector width. Cost: little more than one sample a pixel where
// pixels show one thing. Runs on the threads of the caller's TBB arena.
#pragma once

#include <span>

#include "librender/antialias/filter.h"
#include "librender/raster/resolver.h"

namespace deltaz {

// `environment` and `frame` are those of the sample grid (sample_grid.h), `picture` has the pixels asked for.
// Otherwise as resolve; ResolverStatistics::covered counts samples, `shaded` colours of faces.
ResolverStatistics resolveSamples(const Environment& environment, const TiledFrame& frame,
                                  std::span<const PretiledNode> nodes, const Sampling& sampling,
                                  TextureStore& textures, Picture& picture);

}  // namespace deltaz
