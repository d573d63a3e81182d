// How far two meshes lie apart, measured by samples that lie denser where they lie farther apart. Shares
// nothing with the builder's measure. Internal to libdb/check. Memory: some 100 bytes a triangle. Thread-
// safety: pure functions.
#pragma once

#include "formats/model_file.h"

namespace deltaz {

struct MeshDeviation {
  // Two-sided distance (Hausdorff): a point that lies `sampled` from the other mesh was found, and none lies
  // farther than `bound`.
  double sampled = 0, bound = 0;
};

// Refines until it is known whether the distance lies within `low` .. `high`, or the work would exceed a few
// million samples: then `bound` may stay above `high`, and was not reached by any sample.
MeshDeviation measureDeviation(const ModelMesh& a, const ModelMesh& b, double low, double high);

}  // namespace deltaz
