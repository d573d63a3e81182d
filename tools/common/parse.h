// Numbers and positions as people write them on a command line. Strict: the whole text must be a finite
// number, written with a point whatever the locale says; what is wrong is named together with the option.
// Errors: kUsage. Thread-safety: pure functions.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "formats/area.h"
#include "formats/error.h"
#include "libdb/source/elevation_source.h"

namespace deltaz {

Result<double> parseNumber(std::string_view text, const std::string& option);
Result<double> parseNumberBetween(std::string_view text, const std::string& option, double minimum,
                                  double maximum);
Result<std::int64_t> parseInteger(std::string_view text, const std::string& option, std::int64_t minimum,
                                  std::int64_t maximum);

// "LAT,LON,ALT" or "LAT,LON,ALTagl".
struct EyePosition {
  double latitude = 0;        // degrees, -90 .. 90
  double longitude = 0;       // degrees, -180 .. 360
  double altitude = 0;        // metres
  bool above_ground = false;  // else above the database's datum
};
Result<EyePosition> parseEye(std::string_view text, const std::string& option);

// "HEADING,PITCH[,ROLL]", degrees.
struct LookDirection {
  double heading = 0, pitch = 0, roll = 0;
};
Result<LookDirection> parseLook(std::string_view text, const std::string& option);

// "AZIMUTH,ELEVATION", degrees.
struct SunDirection {
  double azimuth = 0, elevation = 0;
};
Result<SunDirection> parseSun(std::string_view text, const std::string& option);

// "WxH", pixels.
struct PictureSize {
  int width = 0, height = 0;
};
inline constexpr int kMaximumPictureSide = 16384;
Result<PictureSize> parseSize(std::string_view text, const std::string& option);

// "W,S,E,N", degrees. W > E crosses the antimeridian and comes back with east raised by 360.
struct GeodeticBounds {
  double west = 0, south = 0, east = 0, north = 0;
};
Result<GeodeticBounds> parseBounds(std::string_view text, const std::string& option);

// A stored value that means void: a number, or "nan".
Result<double> parseStoredValue(std::string_view text, const std::string& option);

// A height step in metres, exactly: a decimal ("0.01") or a fraction ("381/1250"), 1e-6 .. 1000.
Result<Rational> parseQuantum(std::string_view text, const std::string& option);

// "1as" (arc-seconds; also fractions, "1/3as") or "30m".
Result<PostSpacing> parseSpacing(std::string_view text, const std::string& option);

}  // namespace deltaz
