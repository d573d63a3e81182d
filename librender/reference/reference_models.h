// Placed models for the judge: the finest mesh of every part of every placement, each vertex carried up the
// tree of parts one matrix at a time and to the Earth by GeographicLib, light reckoned in Earth-centred axes.
// Nothing is skipped but faces turned away.
//
// Errors: whatever reading reports. Cost: about 200 bytes a triangle. Thread-safety: pure function.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "formats/error.h"
#include "libdb/access/database.h"
#include "librender/scene/environment.h"
#include "librender/scene/pose_table.h"
#include "librender/scene/render.h"

namespace deltaz {

// Turned to the eye, counter-clockwise.
struct ReferenceModelTriangle {
  std::array<Vector3, 3> position;   // (U, V, W)
  std::array<LinearColor, 3> color;  // of each corner, lit, linear
  std::uint64_t identity = 0;        // as Picture::triangle
};

// Counts triangles in and back faces in `triangles`, and placements in `models`.
Result<std::vector<ReferenceModelTriangle>> referenceModels(const Database& database, const PoseTable& poses,
                                                            const Environment& environment,
                                                            FrameStatistics& statistics);

}  // namespace deltaz
