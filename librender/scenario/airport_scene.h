// The scene of the 1983 report's Table 25 as a database of ours: an approach to an airport in a valley, with
// aircraft. 21,000 terrain triangles (100 x 105 cells of 3 arc-seconds, hills around a flat floor that a
// ridge closes in the north) and 12 models of 300 triangles on the taxiway; the eye 100 m above the ground
// and 600 m before the runway's threshold, 32 degrees wide. What the report does not say is ours.
#pragma once

#include <cstdint>
#include <string>

#include "formats/error.h"
#include "formats/file_system.h"
#include "libdb/access/database.h"
#include "librender/scene/camera.h"

namespace deltaz {

inline constexpr std::int64_t kAirportColumns = 100, kAirportRows = 105;  // cells
inline constexpr int kAircraft = 12, kAircraftTriangles = 300, kAircraftVertices = 152;

// Builds it at `target`, the same bytes every time. Errors: those of building.
Status buildAirport(const FileSystem& files, const std::string& target);

// Looking up the runway.
Result<Camera> airportCamera(const Database& database, int width, int height);

}  // namespace deltaz
