// The tests before set-up for one triangle at a time, as grid_culler.h makes them for rows of cells, without
// its limits: any size within the guard band. Thread-safety: pure functions.
#pragma once

#include <array>
#include <cstdint>

#include "librender/raster/clipper.h"
#include "librender/raster/raster_triangle.h"
#include "librender/raster/tile_bins.h"

namespace deltaz {

enum class TriangleFate : std::uint8_t { kKept, kOutside, kBackFacing, kNoSample };

struct TrianglePlacement {
  TriangleFate fate = TriangleFate::kNoSample;
  TileRange tiles;  // if kept
};

// Snapped coordinates of the vertices in the order of RasterTriangle, all of them in the guard band. `reach`
// as in grid_culler.h.
TrianglePlacement placeTriangle(const std::array<std::int32_t, 3>& x, const std::array<std::int32_t, 3>& y,
                                int width, int height, std::int32_t reach = 0);

// A polygon of at most seven corners on the screen: pieces of one face that was clipped.
struct ClippedFace {
  std::array<RasterVertex, 8> corner;          // payload 0
  std::array<std::array<float, 2>, 8> weight;  // of the face's second and third vertex
  std::size_t corners = 0;
};

// Cuts a face at the hither plane and the guard band; fewer than three corners if nothing is left. Corners
// stay in the order given, so that they run clockwise if `corners_of_face` does.
ClippedFace clipFace(const std::array<Vector3, 3>& corners_of_face);

}  // namespace deltaz
