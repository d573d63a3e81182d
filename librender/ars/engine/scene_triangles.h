// What of a database a view shows, as the triangles that the machine is handed: the same nodes, faces and
// lights that the fast engine draws, as colours at vertices.
//
// The machine knows neither texture nor haze: what the scene's definitions say a vertex looks like from the
// eye is its colour, and runs linearly over the screen from there. A colour map is taken at posts, from the
// level whose texels are as large as the posts lie apart. Runs on the threads of the caller's TBB arena.
// Errors: whatever reading reports. Thread-safety: pure functions.
#pragma once

#include <cstdint>
#include <vector>

#include "formats/error.h"
#include "libdb/access/database.h"
#include "librender/ars/pretiler/screen_triangle.h"
#include "librender/scene/environment.h"
#include "librender/scene/render.h"

namespace deltaz::ars {

struct SceneTriangles {
  // Front faces: terrain from near to far, then models.
  std::vector<ViewTriangle> triangles;
  std::vector<std::uint64_t> identity;  // as Picture::triangle
  std::size_t terrain = 0;              // of them
};

// Of `options` tolerance or fixed level, colour map, poses and culling count. Counts nodes, models, posts and
// faces in `statistics`.
Result<SceneTriangles> sceneTriangles(const Database& database, const Environment& environment,
                                      const RenderOptions& options, FrameStatistics& statistics);

// Sea and sky behind everything: triangles of integer corners that have every pixel once, whose colours are
// within kBackgroundStep of what they stand for, but in squares as small as kSmallestBackground pixels. The
// screen begins at line first_i, pixel first_j of the picture; the last squares may reach beyond the picture.
inline constexpr double kBackgroundStep = 1.5;                          // of 255
inline constexpr int kSmallestBackground = 4, kLargestBackground = 64;  // pixels a side
struct BackgroundTriangle {
  std::array<ScreenPosition, 3> corner;
  std::array<std::array<double, kColors>, 3> color{};
};
std::vector<BackgroundTriangle> backgroundTriangles(const Environment& environment, int first_i, int first_j,
                                                    int lines, int pixels);

}  // namespace deltaz::ars
