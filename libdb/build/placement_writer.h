// Writes the placement file of an edit: placements sorted along a Morton curve of longitude and latitude, so
// that a page holds what stands close together, and the sphere of each page.
//
// Errors: whatever writing reports. Thread-safety: pure functions.
#pragma once

#include <span>
#include <vector>

#include "formats/area.h"
#include "formats/file_system.h"
#include "formats/model_file.h"
#include "formats/placement_file.h"
#include "libdb/build/publication.h"

namespace deltaz {

// Brings placements into the order of the file: along the curve, ties by instance.
void sortPlacements(std::vector<Placement>& placements);

// The sphere, Earth-centred, that holds what stands by default; `models` by Placement::model.
PlacementSphere placementSphere(std::span<const Placement> placements, std::span<const ModelTree> models,
                                const EllipsoidShape& ellipsoid);

// Writes the file and makes `area` name it instead of an earlier one. A database that once had placements
// keeps the file when the last is gone, so that no number is given twice.
Status writePlacements(const FileSystem& files, Publication& publication, AreaHeader& area,
                       std::vector<Placement> placements, std::uint32_t next_instance,
                       std::span<const ModelTree> models);

}  // namespace deltaz
