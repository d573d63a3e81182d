#include "libdb/source/datum_report.h"

#include <array>
#include <fmt/format.h>

#include "libdb/source/source_error.h"

namespace deltaz {

Result<std::string> reportDatumChange(const std::string& path, const ReferenceSystem& from,
                                      const ReferenceSystem& to, double x, double y, bool allow_ballpark) {
  DELTAZ_TRY_ASSIGN(const ReferenceSystem own, geographicOf(from, path));
  DELTAZ_TRY_ASSIGN(const ReferenceSystem target, geographicOf(to, path));
  DELTAZ_TRY_ASSIGN(const CoordinateChange to_own, CoordinateChange::between(from, own, true, path));
  std::array<double, 1> longitude = {x}, latitude = {y};
  (void)to_own.apply(longitude, latitude);
  const DatumChangeFacts facts = datumChangeFacts(own, target, longitude[0], latitude[0]);
  const std::string better =
      facts.missing_grids.empty() ? "" : fmt::format("a better one needs the grid {}", facts.missing_grids);
  const std::string besides = better.empty() ? "" : "; " + better;
  if (!facts.operation.empty()) {
    return fmt::format("{}: placed from datum {} to {} by '{}'{}{}", path, from.horizontal_datum,
                       to.horizontal_datum, facts.operation,
                       facts.accuracy ? fmt::format(", accurate to {} m", *facts.accuracy) : "", besides);
  }
  if (allow_ballpark) {
    return fmt::format(
        "{}: the change from datum {} to {} is a guess, and may be off by hundreds of metres "
        "(--allow-ballpark){}",
        path, from.horizontal_datum, to.horizontal_datum, besides);
  }
  return refusedSource(
      path,
      fmt::format("the change from datum {} to {} can only be guessed", from.horizontal_datum,
                  to.horizontal_datum),
      better.empty() ? "PROJ knows no operation between them here" : better,
      better.empty() ? "Give --allow-ballpark to accept it"
                     : "Put it where PROJ looks (projsync, or the package proj-data), or accept the guess "
                       "with --allow-ballpark");
}

}  // namespace deltaz
