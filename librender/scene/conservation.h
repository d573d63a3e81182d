// Nothing of a frame may be lost on the way: what came in is what was left out, for one reason each, and what
// was drawn. Thread-safety: pure function.
#pragma once

#include <string>

#include "librender/scene/render.h"

namespace deltaz {

// What does not add up, with its numbers: "triangles: 12 came in, 11 were accounted for". Empty if all does:
// nodes and models visited, triangles in, samples written of those tested.
std::string findLoss(const FrameStatistics& statistics);

}  // namespace deltaz
