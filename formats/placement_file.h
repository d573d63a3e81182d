// The placement file: which model stands where. Placements are sorted into pages that lie close together,
// each with the sphere that holds what stands on it, so that a view reads only the pages it needs. Specified
// in placement_file.md.
//
// Source: report 5.1.3.1 (model directory: model and instance identifiers). Errors: kInvalid with
// kPlacementRecord. Thread-safety: plain values and pure functions.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "formats/error.h"

namespace deltaz {

inline constexpr std::uint32_t kPlacementsPerPage = 64;

// A model's anchor stands at latitude, longitude, height, its y axis towards `heading`, its z axis along the
// ellipsoid normal.
struct Placement {
  std::uint32_t instance = 0;          // identifies it: counted from 1, never given twice in a database
  std::uint32_t model = 0;             // index into area.json's models
  double latitude = 0, longitude = 0;  // degrees, -90 .. 90 and -180 .. 180
  double height = 0;                   // metres above the database's datum
  double heading = 0;                  // degrees clockwise from north, 0 <= heading < 360
  bool on_ground = false;              // `height` is the ground's plus above_ground; else above_ground is 0
  double above_ground = 0;             // metres
  bool operator==(const Placement&) const = default;
};

// What stands on one page, as it stands by default: Earth-centred, metres, rounded outwards.
struct PlacementSphere {
  std::array<double, 3> centre{};
  double radius = 0;
  bool operator==(const PlacementSphere&) const = default;
};

// The last block of the file; one page block for each sphere comes before it.
struct PlacementDirectory {
  std::uint32_t count = 0;          // of placements; every page but the last is full
  std::uint32_t next_instance = 1;  // the number the next placement gets
  std::vector<PlacementSphere> pages;
  bool operator==(const PlacementDirectory&) const = default;
};

std::vector<std::byte> encodePlacementDirectory(const PlacementDirectory& directory);
Result<PlacementDirectory> decodePlacementDirectory(std::span<const std::byte> bytes, std::uint32_t blocks,
                                                    const std::string& where);

std::vector<std::byte> encodePlacementPage(std::span<const Placement> placements);
// `models`: how many area.json lists.
Result<std::vector<Placement>> decodePlacementPage(std::span<const std::byte> bytes, std::size_t models,
                                                   const std::string& where);

}  // namespace deltaz
