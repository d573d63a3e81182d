// Terrain objects of the report (6.5.1) in a full-resolution tile: 8 x 8 cells each, at global multiples,
// drawn at the levels scheduled by range (scene/report_schedule.h).
//
// Every other post of one axis is left out at a time, columns first: towards the poles they lie closer
// together than rows, so the cells become squarer. What is drawn is a subset of the tile's posts; the
// diagonal stays SW-NE. An object that the area's end cuts off keeps its last row and column, so no ground is
// lost there. Objects with a void post, or a face that a seam replaced, stay at level 1. Borders between
// levels are left as they come out, cracks included.
//
// Cost: proportional to the tile's posts. Thread-safety: pure functions.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "libdb/access/terrain_tile.h"
#include "libdb/access/vector3.h"
#include "librender/objects/terrain_object_processor.h"
#include "librender/scene/camera.h"
#include "librender/scene/render.h"
#include "librender/scene/report_schedule.h"
#include "librender/scene/view_volume.h"

namespace deltaz {

inline constexpr int kReportObjectCells = 8;  // along a side

// How many posts further the next one of a level is.
struct ReportStep {
  int columns = 1, rows = 1;
};
ReportStep reportStep(int level);

// Posts [first, last] of the tile, both included, and what is drawn of them.
struct ReportObject {
  int first_column = 0, last_column = 0, first_row = 0, last_row = 0;
  ReportLevels levels;
  bool in_view = true;
};

// The objects of a level-0 tile, row by row. `position`: of its posts, in view space. `left_out` as in
// terrainFaces.
std::vector<ReportObject> reportObjects(const TerrainTile& tile, const std::vector<Vector3>& position,
                                        const ViewTransform& view, const ReportRanges& ranges,
                                        const std::vector<std::uint8_t>& left_out = {});

// Faces of the objects in view, as terrainFaces gives them; of an object drawn twice, the finer ones first. A
// face's identity is that of the level-0 face in its south-west (bottom) or north-west (top) corner. Adds
// what becomes of the objects to `statistics`.
TerrainFaces reportFaces(const TerrainTile& tile, const std::vector<Vector3>& position,
                         const std::vector<ReportObject>& objects, FrameStatistics::Objects& statistics,
                         const std::vector<std::uint8_t>& left_out = {});

// Both in one: what a tile draws in a view.
TerrainFaces reportFaces(const TerrainTile& tile, const GridGeometry& geometry, const ViewTransform& view,
                         const ReportLod& lod, const std::vector<Vector3>& position,
                         const std::vector<std::uint8_t>& left_out, FrameStatistics::Objects& statistics);

}  // namespace deltaz
