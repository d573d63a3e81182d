// Coordinate reference systems as the import sees them: what their coordinates are, which datum and ellipsoid
// they refer to, and how to get from one to another through PROJ. A change of datum is never guessed unless
// that is asked for. Thread-safety: values; one thread per CoordinateChange.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>

#include "formats/area.h"
#include "formats/error.h"

namespace deltaz {

struct ReferenceSystem {
  std::string wkt;              // WKT2, with the vertical system if there is one
  std::string name;             // as people know it
  std::optional<double> epoch;  // decimal year, of coordinates in a dynamic datum
  bool projected = false;       // else geographic: degrees from Greenwich
  double metres_per_unit = 1;   // of projected coordinates
  EllipsoidShape ellipsoid;
  std::string horizontal_datum;  // name, or "unknown"
  std::string vertical_datum;    // name, or "unknown"
  std::string vertical_unit;     // of the vertical system; empty if there is none
};

// From anything GDAL takes: WKT, "EPSG:4326", PROJ strings, file names are not taken. kUsage, naming
// `where`, if it is no reference system; kInvalid if it is one whose coordinates are not read here.
Result<ReferenceSystem> parseReferenceSystem(const std::string& text, const std::string& where,
                                             std::optional<double> epoch = {});

// Whether equal coordinates mean equal places: heights aside.
bool sameHorizontalSystem(const ReferenceSystem& a, const ReferenceSystem& b);
// Whether latitudes and longitudes of both mean equal places.
bool sameDatum(const ReferenceSystem& a, const ReferenceSystem& b);

// The geographic system under a projected one (degrees, same datum); a geographic one without its heights.
Result<ReferenceSystem> geographicOf(const ReferenceSystem& system, const std::string& where);

// Turns positions of one system into positions of another, x east and y north (longitude, latitude in
// degrees).
class CoordinateChange {
 public:
  // `where` is named in errors. kInvalid if there is no way, or only a guess without `allow_ballpark`: then
  // the error names the grid files that a proper one needs.
  static Result<CoordinateChange> between(const ReferenceSystem& from, const ReferenceSystem& to,
                                          bool allow_ballpark, const std::string& where);

  // In place. False if some position has no counterpart; those become NaN.
  bool apply(std::span<double> x, std::span<double> y) const;

 private:
  struct Handle;
  CoordinateChange() = default;
  std::shared_ptr<const Handle> handle_;
};

// What PROJ knows about a change of datum at a place (degrees, in `from`'s datum): the best operation it can
// carry out there, and the grid files that better ones would need.
struct DatumChangeFacts {
  std::string operation;           // name; empty if there is none but a guess
  std::optional<double> accuracy;  // metres
  std::string missing_grids;       // comma-separated file names
};
DatumChangeFacts datumChangeFacts(const ReferenceSystem& from, const ReferenceSystem& to, double longitude,
                                  double latitude);

}  // namespace deltaz
