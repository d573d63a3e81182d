// The stored geometric errors of a database against the surfaces themselves, by trying every facet near a
// sample: slow, and independent of how the builder walks.
#pragma once

#include "libdb/access/database.h"
#include "libdb/source/elevation_source.h"

namespace deltaz {

struct DenseSampling {
  int known = 0;      // coarse nodes whose error is known
  int samples = 0;    // places where both surfaces were found under a known error
  double share = 0;   // largest height difference found, as a share of the stored error of the node there
  double excess = 0;  // metres: largest height difference beyond the stored error; 0 if none
};

// `count` places a level, the same every time.
DenseSampling sampleErrors(const Database& database, const RawGrid& grid, int count);

}  // namespace deltaz
