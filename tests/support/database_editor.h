// Takes a small database apart into values, lets a test change them, and puts it together again with every
// length, identity, checksum and hash right: damage that only the rules about meaning can find.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "formats/area.h"
#include "formats/node_file.h"
#include "formats/terrain_segment.h"
#include "tests/support/memory_file_system.h"

namespace deltaz {

class DatabaseEditor {
 public:
  // Throws std::runtime_error if the database is not sound, or has more than one grid or terrain segment.
  DatabaseEditor(MemoryFileSystem& files, const std::string& path);

  AreaHeader area;
  std::vector<NodeRecord> records;               // record n is records[n - 1]
  std::vector<std::vector<std::byte>> payloads;  // of the terrain segment's blocks

  NodeRecord& record(std::uint32_t number) { return records.at(number - 1); }
  // Record number of the terrain node at a position; throws if there is none.
  std::uint32_t numberAt(int level, std::int32_t x, std::int32_t y) const;
  // The first (south-western) node of a level.
  std::uint32_t firstOf(int level) const;
  TerrainBlock block(std::uint32_t number) const;  // of a record
  void setBlock(std::uint32_t number, const TerrainBlock& block);

  std::string nodePath() const { return path_ + "/" + node_reference_name_; }
  std::string terrainPath() const { return path_ + "/" + terrain_reference_name_; }
  std::string areaPath() const;

  // Writes everything back. Lengths and identities in `area` are brought up to date first, node_count too.
  void save();
  // Only area.json, as it stands; with the lengths and identities of the files as they are now if `refresh`.
  void saveArea(bool refresh = false);

 private:
  void refreshReferences();

  MemoryFileSystem& files_;
  std::string path_;
  std::string node_reference_name_, terrain_reference_name_;
};

// Replaces the hash at the end of an area.json's text by the right one.
std::string sealAreaText(const std::string& text);

}  // namespace deltaz
