#include "tools/dbcheck/against_sources.h"

#include "libdb/access/database.h"
#include "libdb/source/area_datum.h"
#include "tools/common/parse.h"

namespace deltaz {

namespace {

// What the database says about how its sources were read. Its own text may be damaged: what cannot be
// understood is left out, and the comparison shows the difference.
SourceOptions recordedOptions(const AreaHeader& area) {
  SourceOptions options;
  for (const auto& [name, value] : area.options) {
    if (name == "crs") options.crs = value;
    if (name == "band") {
      if (const auto band = parseInteger(value, name, 1, 65536); band.ok())
        options.band = static_cast<int>(band.value());
    }
    if (name == "nodata") {
      if (const auto nodata = parseStoredValue(value, name); nodata.ok()) options.nodata = nodata.value();
    }
    if (name == "quantum") {
      if (const auto quantum = parseQuantum(value, name); quantum.ok()) options.quantum = quantum.value();
    }
  }
  // A step that was chosen for a resampled grid is none of its sources'.
  for (const GridHeader& grid : area.grids) {
    if (grid.resampling) options.quantum.reset();
    // What a grid was resampled from is one surface; elsewhere every source is held against its grid.
    options.join = grid.resampling.has_value();
    options.order.insert(options.order.end(), grid.sources.begin(), grid.sources.end());
  }
  if (const std::optional<ReferenceSystem> datum = datumOf(area)) options.datum = datum->wkt;
  options.allow_ballpark = true;  // places are compared, and a guess would show
  return options;
}

}  // namespace

Result<SourceArea> readAgainst(std::span<const std::string> paths, const std::string& crs,
                               const std::string& area) {
  SourceOptions options;
  if (const Result<Database> database = Database::open(localFileSystem(), area); database.ok())
    options = recordedOptions(database.value().area());
  if (!crs.empty()) options.crs = crs;
  return readElevationSources(paths, options);
}

}  // namespace deltaz
