// What the assets of the issue codes are made with: a sound database, and ways to damage a copy of it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <ostream>
#include <string>
#include <vector>

#include "libdb/check/check.h"
#include "tests/support/container_surgery.h"
#include "tests/support/database_editor.h"
#include "tests/support/synthetic_grid.h"

namespace deltaz {

// A recipe makes its own database from a copy of the sound one and checks it.
using Recipe = std::function<Report(MemoryFileSystem)>;

// For one code: a recipe that trips it and no other, and one that looks alike and is sound.
struct Asset {
  IssueCode code;
  Recipe bad;
  Recipe near_miss;
};
void PrintTo(const Asset& asset, std::ostream* out);

// By family of codes, in the order of the codes.
std::vector<Asset> fileAssets();    // IO, HDR, IDX, SUM, MAN
std::vector<Asset> treeAssets();    // REF
std::vector<Asset> tileAssets();    // TILE
std::vector<Asset> heightAssets();  // HGT
std::vector<Asset> errorAssets();   // ERR
std::vector<Asset> sourceAssets();  // SRC
std::vector<Asset> colorAssets();   // COL
std::vector<Asset> modelAssets();   // MDL, PLC

// The source and the sound database: partial leaves all around, one void post.
RawGrid sourceGrid();
BuildOptions smallLeaves();
const MemoryFileSystem& soundDatabase();

// The report on the database in `files`.
Report checkedAt(const FileSystem& files, CheckLevel level = CheckLevel::kDecode,
                 const RawGrid* against = nullptr);
std::string listing(const Report& report);

Recipe byEditing(const std::function<void(DatabaseEditor&)>& edit, CheckLevel level = CheckLevel::kDecode);
// Changes the terrain file's bytes; area.json is then told the file's new length and identity.
Recipe onTerrainBytes(const std::function<void(FileBytes&)>& change);
Recipe onFiles(const std::function<void(MemoryFileSystem&, DatabaseEditor&)>& change);
Recipe untouched(CheckLevel level = CheckLevel::kDecode);

// A sound change where levels below geometry look.
void changeAncestorErrors(DatabaseEditor& editor);
void swapTwoBlocksAndTheirReferences(DatabaseEditor& editor);
// A leaf that has neighbours on all sides and no void.
std::uint32_t innerLeaf(const DatabaseEditor& editor);
// A coarse node (level 1) inside the area, whose posts with odd indices stand in no coarser node.
std::uint32_t innerCoarseNode(const DatabaseEditor& editor);

}  // namespace deltaz
