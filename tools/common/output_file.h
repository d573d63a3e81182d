// Files the tools write: under their name whole or not at all. The bytes go to a temporary file in the same
// folder, onto the disk, and are then put in place by a rename. Errors: kUsage (target exists),
// kCannotAccess.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>

#include "formats/error.h"

namespace deltaz {

// Says now what publishing would say later, so that nobody waits for a picture that cannot be put down: the
// target exists and may not be replaced, is a folder, or its folder is missing or closed to us.
Status checkOutput(const std::string& path, bool overwrite);

Status writeOutput(const std::string& path, std::span<const std::byte> bytes, bool overwrite);
Status writeOutput(const std::string& path, std::string_view text, bool overwrite);

}  // namespace deltaz
