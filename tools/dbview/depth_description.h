// What stands in ImageDescription of a depth file: enough to bring a pixel back to the Earth (dbview(1),
// DEPTH).
#pragma once

#include <string>

#include "libdb/access/database.h"
#include "librender/scene/camera.h"

namespace deltaz {

// One line of JSON. With U the pixel's value, i its row and j its column, all from 0, the point seen is,
// Earth-centred,
//   eye + U * (forward + right * (j - centre_j) / pixels + down * (i - centre_i) / pixels).
std::string depthDescription(const Database& database, const Camera& camera);

}  // namespace deltaz
