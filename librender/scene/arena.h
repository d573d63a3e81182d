// Runs the drawing of one frame on a number of threads, and keeps its exceptions inside the library.
#pragma once

#include <functional>

#include "formats/error.h"
#include "librender/scene/render.h"

namespace deltaz {

// `threads` <= 0: as many as the machine has; never more than that. kCannotAccess if memory runs out.
Result<Picture> drawOnThreads(int threads, const std::function<Result<Picture>()>& draw);

}  // namespace deltaz
