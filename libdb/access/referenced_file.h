// The files area.json refers to, by role. Thread-safety: pure functions.
#pragma once

#include <memory>

#include "formats/area.h"
#include "formats/container.h"
#include "formats/patch_lattice.h"

namespace deltaz {

// What kind of container a file of this role is.
ContentKind contentKindOf(FileRole role);

// The control points of a projected grid, all rows of them. kInvalid with kHgtPatches if they are not those
// that `placement` announces, and whatever reading reports.
Result<std::shared_ptr<const PatchLattice>> readPatchLattice(const ContainerReader& reader,
                                                             const PatchPlacement& placement);

}  // namespace deltaz
