// What the rules of a check share: the opened files, the node records and the tree made of them. Internal to
// libdb/check. Memory: about 130 bytes a node, besides the caches of the rules themselves.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <tuple>
#include <unordered_map>
#include <vector>

#include "formats/area.h"
#include "formats/container.h"
#include "formats/file_system.h"
#include "formats/node_file.h"
#include "formats/seam.h"
#include "formats/terrain_segment.h"
#include "libdb/access/grid_geometry.h"
#include "libdb/access/node_position.h"
#include "libdb/check/check.h"
#include "libdb/check/check_colors.h"
#include "libdb/check/check_models.h"
#include "libdb/check/check_placements.h"

namespace deltaz {

// A file area.json lists, opened if that was possible.
struct CheckedFile {
  FileReference reference;
  std::optional<ContainerReader> container;
  // One for each block, set when the block was reported as unreadable; not reported again. Bytes, not bits:
  // threads that read different blocks write them side by side.
  std::vector<std::uint8_t> damaged_blocks;
};

struct CheckContext {
  CheckContext(const FileSystem& file_system, std::string database, const CheckOptions& check_options)
      : files(file_system), path(std::move(database)), options(check_options) {}

  const FileSystem& files;
  std::string path;
  const CheckOptions& options;
  Report report;

  AreaHeader area;
  std::vector<GridGeometry> grids;
  // False if the control points of a projected grid could not be read: then no position may be asked for.
  bool positions_known = true;
  std::vector<Seam> seams;                         // those that could be decoded
  std::vector<CheckedColorMap> color_maps;         // those whose file could be opened
  std::vector<CheckedModel> models;                // in area.json's order
  std::optional<CheckedPlacements> placements;     // if their directory could be read
  std::vector<CheckedFile> listed;                 // in area.json's order
  CheckedFile* nodes = nullptr;                    // none if it could not be opened
  std::map<std::uint32_t, CheckedFile*> segments;  // listed ones, opened or not

  // Record n is records[n - 1]. Complete only if `records_known`.
  std::vector<NodeRecord> records;
  bool records_known = false;
  // Record number of each record's parent; 0 for the root.
  std::vector<std::uint32_t> parents;
  // The tree and every position in it proved right: rules that go from node to node may rely on it.
  bool tree_sound = false;
  std::unordered_map<NodePosition, std::uint32_t, NodePositionHash> positions;

  const NodeRecord& record(std::uint32_t number) const { return records[number - 1]; }
  // The record at a position, 0 if there is none.
  std::uint32_t recordAt(const NodePosition& position) const {
    const auto found = positions.find(position);
    return found == positions.end() ? 0 : found->second;
  }
  // Where a node is, for people: the longitude and latitude of its middle are added if it is a terrain node.
  IssueLocation locate(std::uint32_t number) const;
};

// The rules, in the order they run. Each writes to context.report.
// area.json and the files it lists, as far as headers and index go. False if nothing further can be checked.
bool openDatabaseFiles(CheckContext& context);
void checkFolder(CheckContext& context);
// Reads the node records and proves the tree; fills records, parents, positions and tree_sound.
void checkTree(CheckContext& context);
void checkChecksums(CheckContext& context);
void checkTerrain(CheckContext& context);
void checkGeometry(CheckContext& context);
void checkAgainstSource(CheckContext& context);
// The part of it for a grid that was resampled.
void checkResampled(CheckContext& context, std::uint16_t grid);

}  // namespace deltaz
