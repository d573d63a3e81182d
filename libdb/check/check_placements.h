// The rules of placements. Internal to libdb/check.
#pragma once

#include "formats/placement_file.h"

namespace deltaz {

struct CheckContext;
struct CheckedFile;

struct CheckedPlacements {
  CheckedFile* file = nullptr;
  PlacementDirectory directory;
};

// How far a model that follows the ground may stand from it, metres.
inline constexpr double kPlacementGroundTolerance = 0.01;

// PLC_RECORD; fills CheckContext::placements.
void checkPlacementRecords(CheckContext& context);
// PLC_SPHERE, PLC_GROUND. Memory: a page of placements and a mesh for each thread.
void checkPlacedModels(CheckContext& context);

}  // namespace deltaz
