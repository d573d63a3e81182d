// Illumination of a tile's posts, and their colours by rule, as lists for a vector unit: the same bits on
// every processor. Scene definitions: the same for every engine. Thread-safety: pure functions.
#pragma once

#include <vector>

#include "libdb/access/tile_posts.h"
#include "libdb/access/vector_lists.h"
#include "librender/scene/illumination.h"

namespace deltaz {

// Light::intensity of each normal; `intensity` is overwritten and padded (libdb/access/vector_lists.h).
void terrainIntensity(const VectorLists& normals, const Light& light, std::vector<double>& intensity);

// Linear colours, one entry a post, padded.
struct PostColors {
  std::vector<double> red, green, blue;
};

// naturalColor (libdb/access/synthetic_color.h) of each post times its intensity. `normals` and `intensity`
// are those of the tile's own posts, row by row; `colors` is overwritten.
void terrainColors(const TilePosts& posts, const VectorLists& normals, const std::vector<double>& intensity,
                   PostColors& colors);

}  // namespace deltaz
