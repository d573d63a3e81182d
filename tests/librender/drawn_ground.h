// The ground as a level-of-detail scheme draws it, and what is wrong with it, found from definitions: how far
// it lies from full resolution; cracks in the picture, as pixels that see the ground from below, and in the
// mesh, as edges that fit no other. Slow and simple on purpose.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "libdb/access/database.h"
#include "librender/scene/report_schedule.h"
#include "tests/librender/cut_checks.h"

namespace deltaz {

// Counter-clockwise seen from above; positions in view space. Front faces and back faces.
struct GroundFace {
  std::array<std::array<std::int64_t, 2>, 3> post{};  // level-0 indices
  std::array<Vector3, 3> position;
};

struct Ground {
  std::vector<GroundFace> faces;
  // Far below the faces and as wide as them: what a ray meets that has come through a crack and goes down.
  std::vector<std::array<Vector3, 3>> floor;
};

// What --lod error draws: the nodes in view of a cut of an area of one grid.
Ground groundOfCut(const Database& database, const CutMesh& mesh, const ViewTransform& view);

// What --lod report draws of an area of one grid. Throws std::runtime_error if it cannot be read.
Ground groundByRange(const Database& database, const ViewTransform& view, const ReportLod& lod);

// One flag a pixel, row by row: its ray meets the underside of a face, or the floor, before any upper side.
// Of ground without voids, over which the eye stands, no ray does but through a crack.
std::vector<std::uint8_t> seenFromBelow(const Ground& ground, const ViewTransform& view);

// Pixels: the largest distance on the screen between a full-resolution post in the picture, hidden or not,
// and the point of a face over it along the ellipsoid normal. Vertices must stand at their posts.
double largestDisplacement(const Database& database, const std::vector<GroundFace>& faces,
                           const FullResolution& full, const ViewTransform& view);

// Edges that no face beyond them shares, though there is a face beyond.
std::uint64_t unmatchedEdges(const std::vector<GroundFace>& faces);

}  // namespace deltaz
