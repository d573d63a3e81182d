// What every database promises, measured on one.
#pragma once

#include "tests/stress/stress_grids.h"

namespace deltaz {

// Holds the database of `named` at kMemoryDatabasePath to everything that can be measured: posts unchanged,
// no error found by a check against the source, posts inside their nodes' spheres, ground heights, stored
// errors against dense sampling.
void holdToPromises(const NamedGrid& named, const MemoryFileSystem& files);

// Builds a database of any grid whatever: either it keeps its promises, or the builder refuses, says why
// (kInvalid), and leaves nothing.
void buildOrRefuse(const NamedGrid& named);

}  // namespace deltaz
