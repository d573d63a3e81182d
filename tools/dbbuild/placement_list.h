// Places of models as people write them: on the command line, in a CSV file, in GeoJSON.
//
// CSV: a line for each place, LAT,LON[,ALT[,HEADING]], ALT as --at takes it or left empty; blank lines and
// those that begin with # are passed over, and so is a first line of titles. GeoJSON: a FeatureCollection, a
// Feature or a geometry of Points; a third coordinate is the altitude above the datum, and the properties
// "altitude" (as --at takes it) and "heading" are followed where they are given.
//
// Errors: kUsage for the command line, kInvalid with line or feature for a file. Thread-safety: pure
// functions.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "libdb/build/place_models.h"

namespace deltaz {

// "LAT,LON[,ALT]", ALT in metres above the datum, or above ground with "agl" at its end.
Result<PlacementRequest> parsePlace(std::string_view text, const std::string& option);

// `heading` holds where the file gives none. `name` is used in messages.
Result<std::vector<PlacementRequest>> parsePlacementList(std::string_view text, const std::string& name,
                                                         double heading);

}  // namespace deltaz
