// Puts models of a database at places, and takes them away again. One edit for all requests: either each has
// its place afterwards, or nothing has changed.
//
// Errors: kUsage naming the request (no such model or instance, no ground there, out of range), and whatever
// reading and writing report. Thread-safety: pure functions; one writer a database.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "formats/file_system.h"
#include "formats/placement_file.h"

namespace deltaz {

struct PlacementRequest {
  double latitude = 0;   // degrees, -90 .. 90
  double longitude = 0;  // degrees, -180 .. 360
  // Metres above the datum, or above the ground; nothing: on the ground.
  std::optional<double> altitude;
  bool above_ground = false;
  double heading = 0;  // degrees clockwise from north, any turn
  std::string where;   // for messages: "--at", "towers.csv, line 3"
};

// The new placements in the order of the requests, with their numbers.
Result<std::vector<Placement>> placeModels(const FileSystem& files, const std::string& target,
                                           const std::string& model,
                                           std::span<const PlacementRequest> requests);

// kUsage unless `instance` is one of `model`.
Status removePlacement(const FileSystem& files, const std::string& target, const std::string& model,
                       std::uint32_t instance);

}  // namespace deltaz
