// The file of --pose: where parts of models have moved to. Specified in dbview(1), MOVED PARTS.
//
// Strict: what is not known is an error with the names that are near. Errors: kCannotAccess; kInvalid for
// text that is no pose file; kUsage for names and instances the database has not.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "formats/error.h"
#include "libdb/access/database.h"
#include "librender/scene/pose.h"

namespace deltaz {

// `where` is the file's name in messages.
Result<std::vector<PartPose>> parsePoses(std::string_view text, const std::string& where);

Result<std::vector<PartPose>> readPoseFile(const std::string& path);

// Reads all placements if a pose names an instance.
Status checkPoses(const Database& database, const std::vector<PartPose>& poses, const std::string& where);

}  // namespace deltaz
