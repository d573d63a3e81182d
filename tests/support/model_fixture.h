// A simple model and its placements in a database, made by the writers and no import: a tower of two parts,
// each a box with a pyramid on top that becomes a flat top in the coarser level of detail.
#pragma once

#include <string>
#include <vector>

#include "formats/file_system.h"
#include "formats/placement_file.h"
#include "libdb/build/model_writer.h"

namespace deltaz {

inline const std::string kFixtureModelName = "tower";

// Part 0, "base": 10 x 6 m in plan, 20 m high, the pyramid 4 m more; face-shaded, colours per triangle.
// Part 1, "head", stands on the pyramid's tip and is free to turn: 4 x 4 m, 4 m high, the pyramid 1 m more;
// curve-shaded, colours per vertex. Both have two levels of detail of 14 and 12 triangles, and errors of 4 m
// and 1 m, which are exact. The anchor is the middle of the base's floor, the model's origin.
FinishedModel fixtureModel();

// Puts it into the database at `target` as kFixtureModelName. Throws std::runtime_error with the message of
// what fails.
void addFixtureModel(const FileSystem& files, const std::string& target,
                     const std::string& name = kFixtureModelName);

// Replaces all placements of the database; `instance` is given by this function, from 1 in their order.
// Throws as above.
void setPlacements(const FileSystem& files, const std::string& target, std::vector<Placement> placements);

// A placement of model 0.
Placement placementAt(double latitude, double longitude, double height, double heading = 0);

}  // namespace deltaz
