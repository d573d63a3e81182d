#include "tools/dbbuild/source_options.h"

#include <limits>

#include "tools/common/parse.h"

namespace deltaz {

void SourceOptionTexts::addTo(CLI::App& app) {
  app.add_option("--bounds", bounds_,
                 "Keep only the posts inside, outwards to the next post; degrees, W > E crosses "
                 "the antimeridian")
      ->type_name("W,S,E,N");
  app.add_option("--grid", grid_,
                 "Posts of the database: the sources' own (source), or resampled to arc-second posts "
                 "(geodetic) or to a projection (default: source)")
      ->type_name("source|geodetic|EPSG:n");
  app.add_option("--spacing", spacing_,
                 "Resample to posts this far apart, in arc-seconds (1as) or metres (30m)")
      ->type_name("SPACING");
  app.add_option("--quantum", quantum_,
                 "Height step in metres (0.01, 381/1250); auto loses nothing where that takes no "
                 "less than 1 mm, else 1 cm (default: auto)")
      ->type_name("METRES|auto");
  app.add_option("--void", voids_, "What becomes of posts without a height (default: keep)")
      ->check(CLI::IsMember({"keep", "fill"}))
      ->type_name("keep|fill");
  app.add_option("--crs", crs_,
                 "What the sources' coordinates refer to, e.g. EPSG:4326; needed where a source does not "
                 "say, and used, with a warning, where it says otherwise")
      ->type_name("CRS");
  app.add_option("--nodata", nodata_, "Stored value that means void, whatever the sources declare")
      ->type_name("V");
  app.add_option("--band", band_, "Band of the elevations, counted from 1")->type_name("N");
  app.add_flag("--allow-ballpark", allow_ballpark_,
               "Accept a change of datum that PROJ can only guess; it may be off by hundreds of metres");
}

Result<SourceOptions> SourceOptionTexts::parse() const {
  SourceOptions options;
  options.crs = crs_;
  options.grid = grid_;
  options.allow_ballpark = allow_ballpark_;
  options.voids = voids_ == "fill" ? VoidPolicy::kFill : VoidPolicy::kKeep;
  if (grid_.empty()) return usageError("--grid", "its value is empty");
  if (!band_.empty()) {
    DELTAZ_TRY_ASSIGN(const std::int64_t band, parseInteger(band_, "--band", 1, 65536));
    options.band = static_cast<int>(band);
  }
  if (!nodata_.empty()) {
    DELTAZ_TRY_ASSIGN(options.nodata, parseStoredValue(nodata_, "--nodata"));
  }
  if (quantum_ != "auto") {
    DELTAZ_TRY_ASSIGN(options.quantum, parseQuantum(quantum_, "--quantum"));
  }
  if (!bounds_.empty()) {
    DELTAZ_TRY_ASSIGN(const GeodeticBounds bounds, parseBounds(bounds_, "--bounds"));
    options.bounds = SourceBounds{bounds.west, bounds.south, bounds.east, bounds.north};
  }
  if (!spacing_.empty()) {
    DELTAZ_TRY_ASSIGN(options.spacing, parseSpacing(spacing_, "--spacing"));
  }
  return options;
}

std::vector<std::pair<std::string, std::string>> SourceOptionTexts::provenance() const {
  std::vector<std::pair<std::string, std::string>> given;
  const auto add = [&](const char* name, const std::string& value, const char* standard) {
    if (value != standard) given.emplace_back(name, value);
  };
  add("allow_ballpark", allow_ballpark_ ? "yes" : "", "");
  add("band", band_, "");
  add("bounds", bounds_, "");
  add("crs", crs_, "");
  add("grid", grid_, "source");
  add("nodata", nodata_, "");
  add("quantum", quantum_, "auto");
  add("spacing", spacing_, "");
  add("void", voids_, "keep");
  return given;
}

}  // namespace deltaz
