// Damage to node records and their links.
#include <gtest/gtest.h>

#include "tests/libdb/check/code_assets.h"

namespace deltaz {

namespace {

std::uint32_t lastChildOf(const DatabaseEditor& editor, std::uint32_t parent) {
  std::uint32_t child = editor.records.at(parent - 1).first_child;
  while (editor.records.at(child - 1).sibling != 0) child = editor.records.at(child - 1).sibling;
  return child;
}

}  // namespace

std::vector<Asset> treeAssets() {
  return {
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
       untouched()},
      {IssueCode::kRefUnreachable, byEditing([](DatabaseEditor& editor) {
         NodeRecord& parent = editor.record(innerCoarseNode(editor));
         parent.first_child = editor.record(parent.first_child).sibling;
       }),
       untouched()},
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
  };
}

}  // namespace deltaz
