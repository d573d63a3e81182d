#include "tests/libdb/check/code_assets.h"

#include <utility>

namespace deltaz {

namespace {

const std::string kPath = kMemoryDatabasePath;

}  // namespace

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

Report checkedAt(const FileSystem& files, CheckLevel level, const RawGrid* against) {
  CheckOptions options;
  options.level = level;
  options.against = against;
  options.against_name = "source";
  return checkDatabase(files, kPath, options);
}

Recipe byEditing(const std::function<void(DatabaseEditor&)>& edit, CheckLevel level) {
  return [edit, level](MemoryFileSystem files) {
    DatabaseEditor editor(files, kPath);
    edit(editor);
    editor.save();
    return checkedAt(files, level);
  };
}

void PrintTo(const Asset& asset, std::ostream* out) {
  *out << issueCodeName(asset.code);
}

Recipe onTerrainBytes(const std::function<void(FileBytes&)>& change) {
  return [change](MemoryFileSystem files) {
    DatabaseEditor editor(files, kPath);
    change(files.mutableBytes(editor.terrainPath()));
    editor.saveArea(true);
    return checkedAt(files);
  };
}

Recipe onFiles(const std::function<void(MemoryFileSystem&, DatabaseEditor&)>& change) {
  return [change](MemoryFileSystem files) {
    DatabaseEditor editor(files, kPath);
    change(files, editor);
    return checkedAt(files);
  };
}

Recipe untouched(CheckLevel level) {
  return [level](const MemoryFileSystem& files) { return checkedAt(files, level); };
}

std::string listing(const Report& report) {
  std::string text = report.fatal ? "fatal: " + report.fatal->message() + "\n" : "";
  for (const IssueGroup& group : report.groups) {
    text += std::string(issueCodeName(group.code)) + " x " + std::to_string(group.count) + ": " +
            group.first.at(0).message + "\n";
  }
  return text;
}

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

std::uint32_t innerLeaf(const DatabaseEditor& editor) {
  const NodeRecord first = editor.records.at(editor.firstOf(0) - 1);
  return editor.numberAt(0, first.x + 1, first.y + 1);
}

std::uint32_t innerCoarseNode(const DatabaseEditor& editor) {
  const NodeRecord first = editor.records.at(editor.firstOf(1) - 1);
  return editor.numberAt(1, first.x + 1, first.y + 1);
}

}  // namespace deltaz
