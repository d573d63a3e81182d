// What people are told of a change of datum. Thread-safety: pure function.
#pragma once

#include <string>

#include "libdb/source/reference_system.h"

namespace deltaz {

// The warning for a source at `path` whose coordinates of `from` are placed in the datum of `to`: which
// operation, how accurate, and what a better one would need. (x, y): a place of the source, in its
// coordinates. kInvalid if the change can only be guessed and nobody allowed that.
Result<std::string> reportDatumChange(const std::string& path, const ReferenceSystem& from,
                                      const ReferenceSystem& to, double x, double y, bool allow_ballpark);

}  // namespace deltaz
