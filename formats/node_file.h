// The node file: the quadtree as records in breadth-first order, several records to a packed and checksummed
// page, so that the first page is a whole coarse area and a view reads only the pages it needs. Specified in
// node_file.md.
//
// Source: report 5.1.4.2.2 (node record), 5.1.3.1 (files). Record numbers start at 1; 0 means none.
// Errors: kInvalid with code kRefRecord. Thread-safety: plain values.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "formats/error.h"

namespace deltaz {

// Small pages, since a view wants few records of each level and they lie apart.
inline constexpr std::uint32_t kNodesPerPage = 16;
// Of the first databases, whose pages were plain.
inline constexpr std::uint32_t kNodesPerPlainPage = 64;
inline constexpr std::size_t kPlainNodeRecordBytes = 96;
inline constexpr std::uint32_t kUnknownError = 0xFFFFFFFF;  // stands for infinity
inline constexpr std::uint8_t kAreaLevel = 255;             // level of the area's own record
inline constexpr std::uint32_t kNoBlock = 0xFFFFFFFF;

enum class NodeType : std::uint8_t { kCluster = 0, kTerrain = 1, kColor = 2, kModel = 3 };

inline constexpr std::uint8_t kNodeHasVoids = 1;  // some post of this node (without the ring) is void
inline constexpr std::uint8_t kNodeIsEmpty = 2;   // no valid post below or in this node; never drawn

struct NodeRecord {
  NodeType type = NodeType::kCluster;
  std::uint8_t level = 0;  // 0 is the finest; a grid's cluster has level_count, the area's 255
  std::uint8_t child_number =
      0;  // 1 SW, 2 SE, 3 NE, 4 NW; 0 for clusters and for the nodes directly under one
  std::uint8_t flags = 0;
  std::uint16_t grid = 0;     // index into area.json's grids
  std::int32_t x = 0, y = 0;  // node covers posts [x, x+1] * leaf_cells * 2^level (global index) in each axis
  std::uint32_t first_child = 0;  // record number; 0 for a leaf
  std::uint32_t sibling = 0;      // next child of the same parent; 0 for the last
  std::uint32_t segment = 0;      // terrain segment and block; kNoBlock for nodes without data
  std::uint32_t block = kNoBlock;
  std::array<std::int32_t, 3>
      centroid_offset{};  // from the parent's centroid, Earth-centred, units of kCentroidUnit
  std::uint32_t radius =
      0;  // of the sphere around the centroid that holds every post below, kCentroidUnit, rounded up
  // Of every valid post below: quanta; the area's own record: whole metres, rounded outwards.
  std::int32_t minimum_height = 0, maximum_height = 0;
  std::array<std::int16_t, 3> mean_normal{};  // Earth-centred unit vector times 32767
  std::uint16_t cone_half_angle = 0;          // units of pi/65535, rounded up: holds every facet normal below
  std::uint32_t geometric_error = kUnknownError;  // kErrorUnit, rounded up
  std::uint32_t coverage_error = kUnknownError;   // kErrorUnit, rounded up
  std::uint32_t rms_error = kUnknownError;        // over posts, kErrorUnit, rounded to nearest
  float lod_near = 0, lod_far = 0;                // metres, the report's ranges; both 0 where none are set
  std::uint32_t valid_posts = 0;                  // of this node, without the ring

  bool operator==(const NodeRecord&) const = default;
  bool isEmpty() const { return (flags & kNodeIsEmpty) != 0; }
};

// The bytes of a page: 1 to kNodesPerPage records, of which the first has number `first_number`.
std::vector<std::byte> encodeNodePage(std::span<const NodeRecord> records, std::uint32_t first_number);

// Checks what a record can say by itself: known type and flags, child number, values within their fields. A
// page has one form, and only that is taken.
Result<std::vector<NodeRecord>> decodeNodePage(std::span<const std::byte> bytes, std::uint32_t first_number,
                                               const std::string& where);

// The same for a plain page: up to kNodesPerPlainPage records of kPlainNodeRecordBytes, reserved bytes zero.
Result<std::vector<NodeRecord>> decodePlainNodePage(std::span<const std::byte> bytes,
                                                    const std::string& where);

}  // namespace deltaz
