// Whether a USGS ASCII DEM holds every profile its header promises: GDAL takes what a file cut short lacks
// for void, without a word.
#pragma once

#include <string>

#include "formats/error.h"

namespace deltaz {

// `profiles` is how many columns GDAL found. kInvalid if the file ends before the last of them does. Cost:
// reads the file once. Thread-safety: pure function.
Status checkUsgsDemComplete(const std::string& path, int profiles);

}  // namespace deltaz
