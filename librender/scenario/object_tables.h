// Tables 25, 26, 28 and 29 of the 1983 report (7.2): what its software did with the frame of an approach to
// an airport, made again with our object processors and levels of detail, beside the published figures.
//
// Times are the least of interleaved rounds on one thread; the report's are of a Gould SEL 32/87, its ratios
// are what compares. Counts are the same on every machine. A count that does not add up is kInternal.
// Other errors: whatever reading and drawing report. Thread-safety: reentrant, but times want the machine.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "formats/error.h"
#include "libdb/access/database.h"
#include "librender/scene/camera.h"

namespace deltaz {

inline constexpr int kScenarioSide = 512;           // pixels
inline constexpr double kScenarioFieldOfView = 32;  // degrees

struct ScenarioRow {
  int table = 0;
  std::string what, scene, unit;
  std::optional<double> published;
  double ours = 0;
};

struct ScenarioView {
  std::string name;
  Camera camera;
  std::uint64_t model_vertices = 0;  // of those drawn
};

// Least milliseconds of each work, which take turns: what else the machine does only ever adds.
std::vector<double> takeTurns(const std::vector<std::function<void()>>& works, int rounds);

// Of Table 25's scene (airport_scene.h).
Status addTable25(const Database& database, const ScenarioView& scene, std::vector<ScenarioRow>& rows);

// Vertices that triangles share. `published`: whether the report's figures are of such a scene; also below.
Status addTable26(const Database& database, const ScenarioView& scene, bool published,
                  std::vector<ScenarioRow>& rows);

// The faces of the largest tile without voids through the terrain's object processor and through the models':
// positions of the posts; the test of faces that all turn out to be back faces.
Status addTable28(int rounds, const Database& database, std::vector<ScenarioRow>& rows);

// Faces with and without levels of detail, by error and as the report did, and what each displaces.
Status addTable29(int rounds, const Database& database, const ScenarioView& scene, bool published,
                  std::vector<ScenarioRow>& rows);

}  // namespace deltaz
