// Every issue code has a recipe that damages a sound database so that this code, and no other, is reported,
// and a near miss that looks alike and is sound. A code without both fails.
#include <functional>
#include <gtest/gtest.h>
#include <map>
#include <ostream>
#include <set>
#include <string>
#include <vector>

#include "libdb/check/check.h"
#include "libdb/check/code_registry.h"
#include "tests/support/container_surgery.h"
#include "tests/support/database_editor.h"
#include "tests/support/fault_file_system.h"
#include "tests/support/synthetic_grid.h"

namespace deltaz {
namespace {

const std::string kPath = kMemoryDatabasePath;

RawGrid sourceGrid() {
  SyntheticGridOptions options;
  // Neither border lies on a leaf boundary, so that there are partial leaves all around.
  options.west = -80 + 5 * 30.0 / 3600;
  options.south = 43 + 3 * 30.0 / 3600;
  options.columns = 41;
  options.rows = 37;
  options.voids = VoidPattern::kSingle;
  return syntheticGrid(options);
}

BuildOptions smallLeaves() {
  BuildOptions options;
  options.leaf_cells = 8;
  return options;
}

const MemoryFileSystem& soundDatabase() {
  static const MemoryFileSystem files = buildInMemory(sourceGrid(), smallLeaves());
  return files;
}

Report check(const FileSystem& files, const RawGrid* against = nullptr) {
  CheckOptions options;
  options.against = against;
  options.against_name = "source";
  return checkDatabase(files, kPath, options);
}

// A recipe makes its own database from a copy of the sound one and checks it.
using Recipe = std::function<Report(MemoryFileSystem)>;

struct Asset {
  IssueCode code;
  Recipe bad;
  Recipe near_miss;
};

Recipe byEditing(const std::function<void(DatabaseEditor&)>& edit) {
  return [edit](MemoryFileSystem files) {
    DatabaseEditor editor(files, kPath);
    edit(editor);
    editor.save();
    return check(files);
  };
}

void PrintTo(const Asset& asset, std::ostream* out) {
  *out << issueCodeName(asset.code);
}

// Changes the terrain file's bytes; area.json is then told the file's new length and identity.
Recipe onTerrainBytes(const std::function<void(FileBytes&)>& change) {
  return [change](MemoryFileSystem files) {
    DatabaseEditor editor(files, kPath);
    change(files.mutableBytes(editor.terrainPath()));
    editor.saveArea(true);
    return check(files);
  };
}

Recipe onFiles(const std::function<void(MemoryFileSystem&, DatabaseEditor&)>& change) {
  return [change](MemoryFileSystem files) {
    DatabaseEditor editor(files, kPath);
    change(files, editor);
    return check(files);
  };
}

Recipe against(const std::function<void(RawGrid&)>& change) {
  return [change](const MemoryFileSystem& files) {
    RawGrid source = sourceGrid();
    change(source);
    return check(files, &source);
  };
}

const Recipe kUntouched = [](const MemoryFileSystem& files) { return check(files); };

// Sound changes that recipes use as near misses.
void changeAncestorErrors(DatabaseEditor& editor) {
  const std::uint32_t leaf = editor.firstOf(0);
  TerrainBlock block = editor.block(leaf);
  block.ancestors.at(0).sum_of_squares += 1;
  editor.setBlock(leaf, block);
}

void swapTwoBlocksAndTheirReferences(DatabaseEditor& editor) {
  const std::uint32_t leaf = editor.firstOf(0);
  std::swap(editor.payloads.at(editor.record(leaf).block), editor.payloads.at(editor.record(leaf + 1).block));
  std::swap(editor.record(leaf).block, editor.record(leaf + 1).block);
}

void addEmptySegment(MemoryFileSystem& files, DatabaseEditor& editor) {
  FileReference reference;
  reference.role = FileRole::kTerrain;
  reference.segment = 1;
  reference.name = "terrain-000001-001.dzt";
  files.setBytes(kPath + "/" + reference.name,
                 makeContainer(ContentKind::kTerrain, BlockType::kTerrainNode, {}));
  editor.area.files.push_back(reference);
  editor.saveArea(true);
}

// A leaf that has neighbours on all sides and no void.
std::uint32_t innerLeaf(const DatabaseEditor& editor) {
  const NodeRecord first = editor.records.at(editor.firstOf(0) - 1);
  return editor.numberAt(0, first.x + 1, first.y + 1);
}

// The leaf that holds the single void post among its own.
std::uint32_t leafWithVoid(const DatabaseEditor& editor) {
  for (std::uint32_t number = 1; number <= editor.records.size(); ++number) {
    const NodeRecord& node = editor.records[number - 1];
    if (node.type == NodeType::kTerrain && node.level == 0 && (node.flags & kNodeHasVoids) != 0)
      return number;
  }
  throw std::runtime_error("no void");
}

std::size_t postIndex(const TerrainBlock& block, int column, int row) {
  return static_cast<std::size_t>(row + 1) * (block.columns + 2u) + static_cast<std::size_t>(column + 1);
}

// Changes the height of one post by one quantum towards the middle of the node's range, so that the range
// stays.
void nudge(DatabaseEditor& editor, std::uint32_t number, int column, int row) {
  TerrainBlock block = editor.block(number);
  const NodeRecord& node = editor.record(number);
  std::int32_t& height = block.heights.at(postIndex(block, column, row));
  ASSERT_NE(height, node.minimum_height);
  ASSERT_NE(height, node.maximum_height);
  height += height * 2 < node.minimum_height + node.maximum_height ? 1 : -1;
  editor.setBlock(number, block);
}

// A coarse node (level 1) inside the area, whose posts with odd indices stand in no coarser node.
std::uint32_t innerCoarseNode(const DatabaseEditor& editor) {
  const NodeRecord first = editor.records.at(editor.firstOf(1) - 1);
  return editor.numberAt(1, first.x + 1, first.y + 1);
}

std::uint32_t lastChildOf(const DatabaseEditor& editor, std::uint32_t parent) {
  std::uint32_t child = editor.records.at(parent - 1).first_child;
  while (editor.records.at(child - 1).sibling != 0) child = editor.records.at(child - 1).sibling;
  return child;
}

const std::vector<Asset>& assets() {
  static const std::vector<Asset> kAssets = {
      {IssueCode::kIoCannotRead,
       [](MemoryFileSystem files) {
         const DatabaseEditor editor(files, kPath);
         return check(FaultFileSystem(files, editor.terrainPath()));
       },
       [](MemoryFileSystem files) { return check(FaultFileSystem(files, kPath + "/lock")); }},
      {IssueCode::kIoMissingFile, onFiles([](MemoryFileSystem& files, DatabaseEditor& editor) {
         (void)files.removeFile(editor.terrainPath());
       }),
       onFiles([](MemoryFileSystem& files, DatabaseEditor&) { (void)files.removeFile(kPath + "/lock"); })},
      {IssueCode::kIoUnreferencedFile, onFiles([](MemoryFileSystem& files, DatabaseEditor&) {
         files.setText(kPath + "/terrain-000000-000.dzt", "old");
       }),
       onFiles([](MemoryFileSystem& files, DatabaseEditor&) { files.setText(kPath + "/lock", "anything"); })},
      {IssueCode::kHdrMagic, onTerrainBytes([](FileBytes& file) { file[0] ^= std::byte{0xFF}; }),
       onFiles([](MemoryFileSystem& files, DatabaseEditor&) {
         files.setText(kPath + "/lock", "no magic here");
       })},
      {IssueCode::kHdrVersionNewer, onTerrainBytes([](FileBytes& file) {
         store(file, kHeaderVersionOffset, std::uint16_t{kContainerVersion + 1});
         sealHeader(file);
       }),
       byEditing([](DatabaseEditor& editor) { editor.area.tool_version = "deltaz 99.0"; })},
      {IssueCode::kHdrFeatureUnknown, onTerrainBytes([](FileBytes& file) {
         store(file, kHeaderRequiredOffset, std::uint32_t{1});
         sealHeader(file);
       }),
       onTerrainBytes([](FileBytes& file) {
         store(file, kHeaderOptionalOffset, std::uint32_t{1});
         sealHeader(file);
       })},
      {IssueCode::kHdrField, onTerrainBytes([](FileBytes& file) {
         store(file, kHeaderReservedOffset, std::uint32_t{1});
         sealHeader(file);
       }),
       onTerrainBytes([](FileBytes& file) {
         store(file, kHeaderOptionalOffset, std::uint32_t{0xFFFFFFFF});
         sealHeader(file);
       })},
      {IssueCode::kHdrChecksum,
       onTerrainBytes([](FileBytes& file) { store(file, kHeaderOptionalOffset, std::uint32_t{1}); }),
       onTerrainBytes([](FileBytes& file) {
         store(file, kHeaderOptionalOffset, std::uint32_t{1});
         sealHeader(file);
       })},
      {IssueCode::kHdrLength, onTerrainBytes([](FileBytes& file) {
         store(file, footerOffset(file) + kFooterLengthOffset, std::uint64_t{file.size() + 8});
         sealFooter(file);
       }),
       // The shortest container there can be: a header and a footer.
       onFiles(addEmptySegment)},
      {IssueCode::kHdrFooter, onTerrainBytes([](FileBytes& file) { file.resize(file.size() + 8); }),
       onFiles(addEmptySegment)},
      {IssueCode::kIdxChecksum,
       onTerrainBytes([](FileBytes& file) { file.at(entryOffset(file, 1) + 16) ^= std::byte{1}; }),
       onTerrainBytes([](FileBytes& file) { sealIndexPages(file); })},
      {IssueCode::kIdxOrder, onTerrainBytes([](FileBytes& file) {
         const BlockLocation first = entryOf(file, 0), second = entryOf(file, 1);
         storeEntry(file, 0, second);
         storeEntry(file, 1, first);
         sealIndexPages(file);
       }),
       byEditing(swapTwoBlocksAndTheirReferences)},
      {IssueCode::kSumBlock,
       onTerrainBytes([](FileBytes& file) { file.at(entryOf(file, 2).offset + 3) ^= std::byte{0x10}; }),
       byEditing(changeAncestorErrors)},
      {IssueCode::kSumFileId, onTerrainBytes([](FileBytes& file) {
         file.at(footerOffset(file) + kFooterIdOffset) ^= std::byte{1};
         sealAll(file, true);
       }),
       byEditing(changeAncestorErrors)},
      {IssueCode::kSumPadding, onTerrainBytes([](FileBytes& file) {
         for (std::uint32_t number = 0; number < blockCount(file); ++number) {
           const BlockLocation block = entryOf(file, number);
           if (block.length % kBlockAlignment == 0) continue;
           file.at(block.offset + block.length) = std::byte{1};
           return;
         }
       }),
       onTerrainBytes([](FileBytes& file) { sealAll(file); })},
      {IssueCode::kManHash, onFiles([](MemoryFileSystem& files, DatabaseEditor& editor) {
         std::string text = files.text(editor.areaPath());
         text.replace(text.find("EGM96"), 5, "EGM08");
         files.setText(editor.areaPath(), text);
       }),
       onFiles([](MemoryFileSystem& files, DatabaseEditor& editor) {
         std::string text = files.text(editor.areaPath());
         text.replace(text.find("EGM96"), 5, "EGM08");
         files.setText(editor.areaPath(), sealAreaText(text));
       })},
      {IssueCode::kManSyntax, onFiles([](MemoryFileSystem& files, DatabaseEditor& editor) {
         files.setText(editor.areaPath(), "{}\n");
       }),
       byEditing([](DatabaseEditor& editor) {
         editor.area.options = {{"leaf", "\"}\n{ [ \\"}};
       })},
      {IssueCode::kManField,
       byEditing([](DatabaseEditor& editor) { editor.area.grids[0].normal_exponent = -1; }),
       byEditing([](DatabaseEditor& editor) { editor.area.generation = 1234567; })},
      {IssueCode::kManFileMismatch, onFiles([](MemoryFileSystem& files, DatabaseEditor& editor) {
         const std::string area = files.text(editor.areaPath());
         changeAncestorErrors(editor);
         editor.save();
         files.setText(editor.areaPath(), area);
       }),
       byEditing(changeAncestorErrors)},
      {IssueCode::kRefRange, byEditing([](DatabaseEditor& editor) {
         editor.records.back().sibling = static_cast<std::uint32_t>(editor.records.size()) + 1;
       }),
       // The last sibling link leads to the last record there is.
       byEditing([](DatabaseEditor& editor) {
         ASSERT_EQ(editor.records.at(editor.records.size() - 2).sibling, editor.records.size());
       })},
      {IssueCode::kRefCycle, byEditing([](DatabaseEditor& editor) {
         const std::uint32_t parent = editor.firstOf(1);
         editor.record(lastChildOf(editor, parent)).sibling = editor.record(parent).first_child;
       }),
       kUntouched},
      {IssueCode::kRefUnreachable, byEditing([](DatabaseEditor& editor) {
         NodeRecord& parent = editor.record(innerCoarseNode(editor));
         parent.first_child = editor.record(parent.first_child).sibling;
       }),
       kUntouched},
      {IssueCode::kRefChild,
       byEditing([](DatabaseEditor& editor) { editor.record(innerLeaf(editor)).child_number ^= 1; }),
       // Nodes under a cluster have child number 0.
       byEditing([](DatabaseEditor& editor) { ASSERT_EQ(editor.record(3).child_number, 0); })},
      {IssueCode::kRefRecord,
       byEditing([](DatabaseEditor& editor) { editor.record(innerLeaf(editor)).flags |= 0x80; }),
       byEditing([](DatabaseEditor& editor) {
         editor.record(innerLeaf(editor)).lod_near = 100;
         editor.record(innerLeaf(editor)).lod_far = 100;
       })},
      {IssueCode::kRefData, byEditing([](DatabaseEditor& editor) {
         editor.record(innerLeaf(editor)).block = static_cast<std::uint32_t>(editor.payloads.size());
       }),
       byEditing(swapTwoBlocksAndTheirReferences)},
      {IssueCode::kRefMissing, byEditing([](DatabaseEditor& editor) {
         editor.records.pop_back();
         editor.records.back().sibling = 0;
       }),
       // Nodes at the area's edge have fewer than four children.
       byEditing([](DatabaseEditor& editor) {
         const std::uint32_t corner = editor.firstOf(1);
         const std::uint32_t child = editor.record(corner).first_child;
         ASSERT_NE(editor.record(child).child_number, 1);
       })},
      {IssueCode::kTileGrid, byEditing([](DatabaseEditor& editor) {
         TerrainBlock block = editor.block(innerLeaf(editor));
         block.quantum = {2, 1};
         editor.setBlock(innerLeaf(editor), block);
       }),
       byEditing(changeAncestorErrors)},
      {IssueCode::kTileHeightRange,
       byEditing([](DatabaseEditor& editor) { editor.record(innerLeaf(editor)).minimum_height -= 1; }),
       // Empty leaves have no range, and their parents do without.
       [](const MemoryFileSystem&) {
         SyntheticGridOptions options;
         options.voids = VoidPattern::kWestHalf;
         options.lowest = 10;
         return check(buildInMemory(syntheticGrid(options), smallLeaves()));
       }},
      {IssueCode::kTileVoids,
       byEditing([](DatabaseEditor& editor) { editor.record(innerLeaf(editor)).valid_posts -= 1; }),
       byEditing([](DatabaseEditor& editor) {
         ASSERT_EQ(editor.record(leafWithVoid(editor)).flags, kNodeHasVoids);
       })},
      {IssueCode::kTileSphere, byEditing([](DatabaseEditor& editor) {
         NodeRecord& node = editor.record(innerLeaf(editor));
         node.radius -= node.radius / 10;
       }),
       byEditing([](DatabaseEditor& editor) { editor.record(innerLeaf(editor)).radius += 1; })},
      {IssueCode::kHgtDecode, byEditing([](DatabaseEditor& editor) {
         // The count of ancestors no longer adds up with the block's length.
         editor.payloads.at(editor.record(innerLeaf(editor)).block).at(3) ^= std::byte{1};
       }),
       byEditing(changeAncestorErrors)},
      // An odd post in the middle of a coarse node: no coarser node has it, no neighbour sees it.
      {IssueCode::kHgtSubset,
       byEditing([](DatabaseEditor& editor) { nudge(editor, innerCoarseNode(editor), 3, 5); }), kUntouched},
      // A ring post one step outside the western border.
      {IssueCode::kHgtRing,
       byEditing([](DatabaseEditor& editor) { nudge(editor, innerLeaf(editor), -1, 4); }),
       // What stands at a void post means nothing: here in a ring outside the area.
       byEditing([](DatabaseEditor& editor) {
         const std::uint32_t corner = editor.firstOf(0);
         TerrainBlock block = editor.block(corner);
         ASSERT_EQ(block.valid.at(postIndex(block, 0, -1)), 0);
         block.heights.at(postIndex(block, 0, -1)) += 5;
         editor.setBlock(corner, block);
       })},
      // A post with an odd row on the eastern border, away from the corners: no parent and no ring has it.
      {IssueCode::kHgtBorder,
       byEditing([](DatabaseEditor& editor) { nudge(editor, innerLeaf(editor), 8, 3); }), kUntouched},
      {IssueCode::kSrcHeight, against([](RawGrid& source) { source.heights.at(500) += 1; }),
       against([](RawGrid& source) {
         // The void post: its height means nothing.
         for (std::size_t i = 0; i < source.valid.size(); ++i)
           source.heights[i] += source.valid[i] == 0 ? 77 : 0;
       })},
      {IssueCode::kSrcVoid, against([](RawGrid& source) { source.valid.at(500) = 0; }),
       against([](RawGrid&) {})},
      {IssueCode::kSrcExtent, against([](RawGrid& source) {
         source.header.y_axis.count -= 1;
         const auto size =
             static_cast<std::size_t>(source.header.y_axis.count * source.header.x_axis.count);
         source.heights.resize(size);
         source.valid.resize(size);
       }),
       against([](RawGrid& source) { source.header.sources[0].name = "another name.tif"; })},
      {IssueCode::kSrcGeoreference, against([](RawGrid& source) { source.header.x_axis.phase = 0.5; }),
       // A geotransform that went through text.
       against([](RawGrid& source) {
         source.header.x_axis.exact_spacing.reset();
         source.header.x_axis.spacing *= 1 + 1e-13;
       })},
  };
  return kAssets;
}

std::string listing(const Report& report) {
  std::string text = report.fatal ? "fatal: " + report.fatal->message() + "\n" : "";
  for (const IssueGroup& group : report.groups) {
    text += std::string(issueCodeName(group.code)) + " x " + std::to_string(group.count) + ": " +
            group.first.at(0).message + "\n";
  }
  return text;
}

class CodeAssets : public testing::TestWithParam<Asset> {};

TEST_P(CodeAssets, recipe_trips_this_code_and_no_other) {
  const Report report = GetParam().bad(soundDatabase());
  EXPECT_FALSE(HasFailure());
  ASSERT_EQ(report.groups.size(), 1u) << listing(report);
  EXPECT_EQ(report.groups[0].code, GetParam().code) << listing(report);
  EXPECT_EQ(report.groups[0].severity, describe(GetParam().code).severity);
  EXPECT_GE(report.groups[0].count, 1u);
}

TEST_P(CodeAssets, near_miss_is_clean) {
  const Report report = GetParam().near_miss(soundDatabase());
  EXPECT_TRUE(report.groups.empty()) << listing(report);
  EXPECT_TRUE(report.complete);
  EXPECT_FALSE(report.fatal.has_value());
}

INSTANTIATE_TEST_SUITE_P(All, CodeAssets, testing::ValuesIn(assets()), [](const auto& information) {
  return std::string(issueCodeName(information.param.code));
});

TEST(CodeRegistry, every_code_has_exactly_one_recipe) {
  std::map<IssueCode, int> recipes;
  for (const Asset& asset : assets()) ++recipes[asset.code];
  for (const CodeDescription& code : codeRegistry()) {
    EXPECT_EQ(recipes[code.code], 1) << issueCodeName(code.code) << " has no recipe that trips it alone";
  }
  EXPECT_EQ(recipes.size(), codeRegistry().size());
}

TEST(CodeRegistry, every_code_is_explained) {
  std::set<std::string_view> titles;
  for (const CodeDescription& code : codeRegistry()) {
    EXPECT_EQ(&describe(code.code), &code);
    EXPECT_TRUE(titles.insert(code.title).second) << code.title;
    EXPECT_GT(code.explanation.size(), 40u) << issueCodeName(code.code);
    EXPECT_GT(code.remedy.size(), 10u) << issueCodeName(code.code);
    EXPECT_NE(code.section.find(".md "), std::string_view::npos) << issueCodeName(code.code);
    EXPECT_EQ(issueCodeFromName(issueCodeName(code.code)), code.code);
  }
}

TEST(SoundDatabase, is_clean_at_every_level) {
  for (const CheckLevel level : {CheckLevel::kStructure, CheckLevel::kChecksum, CheckLevel::kDecode}) {
    CheckOptions options;
    options.level = level;
    const Report report = checkDatabase(soundDatabase(), kPath, options);
    EXPECT_TRUE(report.groups.empty()) << listing(report);
    EXPECT_TRUE(report.complete);
  }
}

}  // namespace
}  // namespace deltaz
