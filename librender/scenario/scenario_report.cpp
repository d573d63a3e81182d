#include "librender/scenario/scenario_report.h"

#include <cctype>
#include <cstdint>
#include <fmt/format.h>
#include <string>
#include <string_view>

#include "formats/memory_file_system.h"
#include "librender/scenario/airport_scene.h"
#include "librender/scenario/object_tables.h"

namespace deltaz {

namespace {

constexpr const char* kPlace = "/airport.dz";

constexpr const char* kSceneOurs = "the report says of its scene what Table 25 says; the rest is ours";
constexpr const char* kOtherFrame =
    "of another frame: the report's 80,000 and 95,000 are more than its scenario's 24,600 triangles have; "
    "shares and ratios compare";
constexpr const char* kOtherMachine =
    "published of a Gould SEL 32/87; the speed-up compares: our terrain's test runs in vectors and the "
    "models' "
    "does not, and tiles are small, which the transformation of posts by line and column feels";
constexpr const char* kLevels =
    "does not reproduce: the report's frame has 95,000 terrain faces, its scenario 21,000, which end 9.7 km "
    "away, before the second range begins; and where levels go by error, hidden ground is left out before";
constexpr const char* kNotSaid = "the report does not say";

// Lower case, words joined by underscores; what stands behind a colon is a part of its own.
std::string idOf(int table, std::string_view what) {
  std::string id = fmt::format("table{}.", table);
  if (table == 25) id += "scene.";
  for (const char letter : what) {
    const bool plain = std::isalnum(static_cast<unsigned char>(letter)) != 0;
    if (plain) {
      id += static_cast<char>(std::tolower(static_cast<unsigned char>(letter)));
    } else if (letter == '\'') {
      continue;
    } else if (letter == ':') {
      id += '.';
    } else if (id.back() != '_' && id.back() != '.') {
      id += '_';
    }
  }
  return id;
}

const char* noteOf(const ScenarioRow& row) {
  if (!row.published) return kNotSaid;
  if (row.table == 25) return kSceneOurs;
  if (row.table == 26) return kOtherFrame;
  if (row.table == 28) return kOtherMachine;
  return kLevels;
}

}  // namespace

Result<std::vector<ars::ReportRow>> scenarioReportRows(int rounds) {
  MemoryFileSystem files;
  DELTAZ_TRY(buildAirport(files, kPlace));
  DELTAZ_TRY_ASSIGN(const Database airport, Database::open(files, kPlace));
  DELTAZ_TRY_ASSIGN(const Camera approach, airportCamera(airport, kScenarioSide, kScenarioSide));
  const ScenarioView scene{"Table 25's scene", approach, std::uint64_t{kAircraft} * kAircraftVertices};
  std::vector<ScenarioRow> found;
  DELTAZ_TRY(addTable25(airport, scene, found));
  DELTAZ_TRY(addTable26(airport, scene, true, found));
  DELTAZ_TRY(addTable28(rounds, airport, found));
  DELTAZ_TRY(addTable29(rounds, airport, scene, true, found));
  std::vector<ars::ReportRow> rows;
  for (const ScenarioRow& row : found) {
    const std::string_view what = std::string_view(row.what).substr(row.what.find_first_not_of(' '));
    rows.push_back(
        {.id = idOf(row.table, what),
         .description = fmt::format("{}: {}{}{}", row.scene, what, row.unit.empty() ? "" : ", ", row.unit),
         .published = row.published,
         .ours = row.ours,
         .note = noteOf(row)});
  }
  return rows;
}

}  // namespace deltaz
