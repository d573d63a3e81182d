// Damage to files, their headers, indexes and checksums, and to area.json.
#include <gtest/gtest.h>

#include "tests/libdb/check/code_assets.h"
#include "tests/support/fault_file_system.h"

namespace deltaz {

namespace {

const std::string kPath = kMemoryDatabasePath;

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

}  // namespace

std::vector<Asset> fileAssets() {
  return {
      {IssueCode::kIoCannotRead,
       [](MemoryFileSystem files) {
         const DatabaseEditor editor(files, kPath);
         return checkedAt(FaultFileSystem(files, editor.terrainPath()));
       },
       [](MemoryFileSystem files) { return checkedAt(FaultFileSystem(files, kPath + "/lock")); }},
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
  };
}

}  // namespace deltaz
